#include "app/view/session/script_calls.h"

#include <algorithm>

namespace pectora::view {
namespace {

// By name: a table of Lua has no order of its own.
Settings sorted(Settings settings) {
  std::sort(settings.begin(), settings.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return settings;
}

std::string stageOf(const std::string& id) { return id.substr(0, id.find('.')); }

bool isMadeBy(const std::vector<Handle>& handles, const std::string& stage) {
  return !handles.empty() && handles.front().record && stageOf(handles.front().record->stage) == stage;
}

// Landmarks that a script brings; the phantom's own need not be placed.
Landmarks placedBy(const std::vector<Handle>& handles) {
  if (handles.empty() || isMadeBy(handles, "loader")) return {};
  const auto* landmarks = dynamic_cast<const Landmarks*>(handles.front().value.get());
  return landmarks ? *landmarks : Landmarks{};
}

}  // namespace

void ScriptCalls::starting(const std::string& id, const Settings& settings, const Runner::PortInputs& inputs) {
  const std::string stage = stageOf(id);
  if (stage == "report" || (stage == "solver" && hasSolve_)) throw Cancelled();
  const PluginChoice call{id, sorted(settings)};
  if (stage == "loader") choices_.loader = call, choices_.source = id == "loader.phantom" ? Source::phantom : Source::dicom;
  else if (stage == "segmenter") choices_.segmenter = call, choices_.corrections.clear();
  else if (stage == "correct") choices_.corrections.push_back(call);
  else if (stage == "splines") choices_.splines = call;
  else if (stage == "planner") choices_.planner = call, hasPlan_ = true;
  else if (stage == "solver") choices_.solver = call, hasSolve_ = true;
  else if (id == "scan.file") choices_.scan = call;
  else if (id == "register.icp") choices_.icp = call, choices_.usesIcp = true;
  else if (id == "comparer.surface" && isMadeBy(inputs.at(0), "register")) choices_.comparer = call;   // of several the scan's
  else if (stage == "model") {
    choices_.model = call;
    choices_.effects.clear();
    hasModel_ = true;
    for (const std::vector<Handle>& port : inputs)
      for (const Handle& handle : port)
        if (const auto* effect = dynamic_cast<const EffectCall*>(handle.value.get())) choices_.effects.push_back({{effect->id, sorted(effect->settings)}, true});
  } else if (id == "register.landmarks") {
    hasRegistration_ = true;
    choices_.registration = call;
    choices_.usesIcp = false;   // unless it is called, too
    choices_.scanLandmarks = placedBy(inputs.at(1));
    choices_.ctLandmarks = placedBy(inputs.at(2));
  }
}

Choices ScriptCalls::choices(const Choices& present) const {
  if (!hasPrediction())
    throw Error("the script makes no prediction that a window could show: it needs a model, a planner and a solver")
        .advise("Run it by `pectora run`, and open the folder that it writes");
  Choices made = choices_;
  if (!hasRegistration_) made.usesIcp = present.usesIcp;
  reset(made.solver.settings, kAcceptUnconverged);   // the window always shows the status
  return made;
}

}  // namespace pectora::view
