// What all panels share.
#pragma once

#include "app/view/platform/folders.h"
#include "app/view/render/renderer.h"
#include "app/view/session/catalog.h"
#include "app/view/session/worker.h"

#include <optional>

namespace pectora::view {

/// The steps of the work, as tabs from left to right.
enum class Tab { patient, anatomy, bar, tissue, compare, accuracy, script };
inline constexpr int kTabs = 7;

enum class SkinLook { natural, glass, displacement, distance, hidden };
/// Whether it hides what lies behind it.
inline bool isOpaque(SkinLook look) { return look != SkinLook::glass && look != SkinLook::hidden; }

/// How the scene is shown. Not part of what is computed.
struct SceneOptions {
  SkinLook skin = SkinLook::natural;
  bool hasBones = true, hasBar = true, hasScan = false, hasSprings = true;
  float part = 1;              ///< 0 before, 1 after
  bool isRangeFixed = false;   ///< of the colour bar
  float range = 30;            ///< its end, mm
  ClipPlane clip;
  int clipAxis = 0;            ///< 0 x, 1 y, 2 z
  float clipAt = 0;            ///< mm from the target
};

/// The parts of the window, in units of the layout; kept between sessions.
struct Layout {
  float left = 344, right = 264, console = 200;
  int width = 1280, height = 800;   ///< of the window, pixels
  void load();
  void save() const;
};

/// A turn about the patient that is being drawn, a picture with each frame.
struct Turntable {
  std::string folder;
  int drawn = 0;
  static constexpr int kPictures = 36;
};

struct PickedPoint {
  int point = 0;
  std::vector<PickedSpring> springs;
  bool isKnown = false;   ///< whether the springs have come
};

/// What tasks of the worker leave for the window.
struct Inbox {
  std::mutex mutex;
  std::optional<std::vector<PickedSpring>> springs;
  std::optional<std::vector<EffectWorth>> worths;
  std::optional<Choices> choices;
  std::optional<Study> study;
};

class Context {
 public:
  Context(Registry& registry, std::function<void()> wake);

  Catalog catalog;
  RecentFiles recent;
  Choices choices;
  History history;
  SceneOptions scene;
  Layout layout;
  Tab tab = Tab::patient;
  float scale = 1;                     ///< pixels of one unit of the layout
  std::shared_ptr<const Results> results;
  std::vector<Fact> planFacts, motionFacts;   ///< of the results' plan and motion
  Activity activity;
  std::vector<LogLine> log;
  std::optional<PickedPoint> picked;
  std::vector<EffectWorth> worths;     ///< empty: not measured for the present scene
  std::optional<Study> study;          ///< of the present scene and plan
  std::string typedPath, typedScan, presetName = "my preset";   ///< what stands in those fields
  std::string outFolder = "pectora_result";   ///< for files that are asked for
  std::string message;                 ///< what went wrong, for the status line; empty: nothing
  std::string notice;                  ///< what was last told, such as where a file is
  std::optional<std::string> wantedPicture;   ///< path of a PNG of the next frame
  std::optional<Turntable> turntable;         ///< until it is done

  /// Takes over what the worker has to tell. Once a frame.
  void refresh();
  /// The choices have changed; `isDragging`: and will again at once. A change that has come to its end can be undone.
  void changed(bool isDragging);
  void undo();
  void redo();
  /// Opens a folder of DICOM, a DICOMDIR, a surface (as the scan after the operation), landmarks on both (.csv), a script, a preset, or a
  /// folder of results, by its path. Another patient has another scan.
  void open(const std::string& path);
  void openPhantom();
  void pickPoint(int point);
  void measureEffects();
  void studyScene();
  /// The path of a file in outFolder, which is made: NAME.png, or NAME_2.png and so on where `isNew` and that is there already.
  std::string outPath(const std::string& name, bool isNew = false) const;
  /// Writes the next frame into outFolder.
  void takeScreenshot() { wantedPicture = outPath("screenshot.png", true); }
  Worker& worker() { return worker_; }

 private:
  std::shared_ptr<Inbox> inbox_ = std::make_shared<Inbox>();
  Worker worker_;   // last: its thread ends first
};

}  // namespace pectora::view
