// Everything that the user has chosen. What the window shows follows from this alone, and so does its script.
#pragma once

#include "kernel/value/mesh.h"
#include "kernel/value/settings.h"

#include <string>
#include <vector>

namespace pectora::view {

/// A plugin and those of its settings that were changed.
struct PluginChoice {
  std::string id;
  Settings settings = {};
  bool operator==(const PluginChoice&) const = default;
};

struct EffectChoice {
  PluginChoice plugin;
  bool isOn = true;
  bool operator==(const EffectChoice&) const = default;
};

/// A result is a folder that a run wrote: its skins are shown and compared, but nothing can be moved.
enum class Source { none, dicom, phantom, result };

struct Choices {
  Source source = Source::none;
  PluginChoice loader;          ///< of the source: its path, or the phantom's settings
  PluginChoice segmenter{"segmenter.thorax"}, splines{"splines.cartilage"}, model{"model.two_layer"}, planner{"planner.nuss"}, solver;
  std::vector<PluginChoice> corrections;      ///< of the anatomy by hand, in order
  std::vector<EffectChoice> effects;
  PluginChoice scan{"scan.file"};             ///< of a scan after the operation; without a path the phantom's own, or none
  Landmarks ctLandmarks, scanLandmarks;       ///< placed by hand; none: the phantom's own
  PluginChoice registration{"register.landmarks"}, icp{"register.icp"}, comparer{"comparer.surface", {{"name", std::string("scan_vs_simulated")}}};
  bool usesIcp = true;

  /// Whether a scan was opened.
  bool hasScan() const { return !scan.settings.empty(); }
};

/// The steps from a file to a comparison, in the order in which they depend on each other.
enum class Step { source, anatomy, corrections, cage, scene, plan, motion, scan, registration, comparison, nothing };
/// The first step whose result differs between two sets of choices.
Step firstDifference(const Choices& a, const Choices& b);

/// The default scene of scripts/correction.lua. `solvers` are the ids that there are.
Choices initialChoices(const std::vector<std::string>& solvers);

/// The value of a setting, or null if it has its default.
const SettingValue* find(const Settings& settings, const std::string& name);
void assign(Settings& settings, const std::string& name, SettingValue value);
void reset(Settings& settings, const std::string& name);

/// Steps back and forth through choices. A drag is one step: it is kept when it ends.
class History {
 public:
  void begin(const Choices& first);
  /// Keeps `now` if it differs from the present step.
  void keep(const Choices& now);
  bool canUndo() const { return present_ > 0; }
  bool canRedo() const { return present_ + 1 < steps_.size(); }
  const Choices& undo() { return steps_[--present_]; }
  const Choices& redo() { return steps_[++present_]; }

 private:
  std::vector<Choices> steps_;
  std::size_t present_ = 0;
};

}  // namespace pectora::view
