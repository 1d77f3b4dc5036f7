// The whole window: its layout, and one frame after another.
#pragma once

#include "app/view/context.h"
#include "app/view/panels/anatomy_panel.h"
#include "app/view/panels/compare_panel.h"
#include "app/view/panels/scene_panel.h"
#include "app/view/panels/script_panel.h"
#include "app/view/platform/target.h"

#include <array>

namespace pectora::view {

/// ImGui's own state, which must exist before the target and outlive it. The target's scale then sets the theme.
struct ImGuiHolder {
  ImGuiHolder();
  ~ImGuiHolder();
  ImGuiHolder(const ImGuiHolder&) = delete;
  ImGuiHolder& operator=(const ImGuiHolder&) = delete;
};

class App {
 public:
  App(Target& target, Registry& registry, std::function<void()> wake);

  /// Draws one frame.
  void frame();
  /// Frames that are still due without any event: the layout settles, or edges become fine.
  bool wantsFrame() const;
  /// Seconds until the next frame is due without any event; 1e9: none is.
  double untilFrame() const;
  /// Writes the last frame as a PNG.
  void savePicture(const std::string& path) const;
  /// Remembers the parts of the window for the next time.
  void keepLayout();
  Context& context() { return context_; }
  Camera& camera() { return scene_.camera(); }

 private:
  void topBar(float width, float height);
  void leftColumn(float width, float height);
  void center(float width, float height);
  void opening(float width, float height);
  void splitter(const char* name, float x, float y, float height, float& value, float sign);
  void shortcuts();
  void takePictures();

  Target& target_;
  Context context_;
  Renderer renderer_;
  ScenePanel scene_{renderer_};
  AnatomyPanel anatomy_;
  ComparePanel compare_{renderer_};
  ScriptPanel script_;
  int settling_ = 3;            // frames that are drawn in any case
  bool isCoarse_ = false;       // the picture that is shown becomes finer in the next frame
  /// What each tab shows of the scene while another is open; that of the open one is in the context.
  struct TabLook {
    SkinLook skin = SkinLook::natural;
    bool hasBones = true, hasBar = true, hasScan = false;
    float part = 1;
  };
  std::array<TabLook, kTabs> looks_{{{},
                                     {.skin = SkinLook::glass, .hasBar = false, .part = 0},   // as the CT is
                                     {.skin = SkinLook::glass},
                                     {.skin = SkinLook::displacement},
                                     {.skin = SkinLook::hidden, .hasBones = false, .hasScan = true},
                                     {},
                                     {}}};
  Tab lastTab_ = Tab::patient;
};

}  // namespace pectora::view
