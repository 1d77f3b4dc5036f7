#include "app/view/session/choices.h"

#include <algorithm>

namespace pectora::view {
namespace {

bool same(const Landmarks& a, const Landmarks& b) {
  return std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                    [](const Landmark& x, const Landmark& y) { return x.name == y.name && x.position == y.position; });
}

}  // namespace

Step firstDifference(const Choices& a, const Choices& b) {
  if (a.source != b.source || a.loader != b.loader) return Step::source;
  if (a.segmenter != b.segmenter) return Step::anatomy;
  if (a.corrections != b.corrections) return Step::corrections;
  if (a.splines != b.splines) return Step::cage;
  if (a.model != b.model || a.effects != b.effects) return Step::scene;
  if (a.planner != b.planner) return Step::plan;
  if (a.solver != b.solver) return Step::motion;
  if (a.scan != b.scan) return Step::scan;
  // The comparison begins where the landmarks brought the scan, so both are made together.
  if (!same(a.ctLandmarks, b.ctLandmarks) || !same(a.scanLandmarks, b.scanLandmarks) || a.registration != b.registration || a.usesIcp != b.usesIcp ||
      a.icp != b.icp || a.comparer != b.comparer)
    return Step::registration;
  return Step::nothing;
}

Choices initialChoices(const std::vector<std::string>& solvers) {
  // The fastest on walls as coarse as a window moves at once.
  Choices c;
  for (const char* id : {"solver.newton", "solver.lbfgs"})
    if (c.solver.id.empty() && std::find(solvers.begin(), solvers.end(), id) != solvers.end()) c.solver.id = id;
  if (c.solver.id.empty() && !solvers.empty()) c.solver.id = solvers.front();
  // The effects of scripts/correction.lua, where slack skin gives way.
  const Settings skin{{"compression", 0.02}};
  c.effects = {{{"effect.stretch", skin}}, {{"effect.shear", skin}}, {{"effect.bend", skin}}, {{"effect.direct"}}, {{"effect.cross"}}, {{"effect.volume"}}, {{"effect.attachment"}}, {{"effect.rib_contact"}}};
  return c;
}

const SettingValue* find(const Settings& settings, const std::string& name) {
  for (const auto& [known, value] : settings)
    if (known == name) return &value;
  return nullptr;
}

void assign(Settings& settings, const std::string& name, SettingValue value) {
  for (auto& [known, old] : settings)
    if (known == name) {
      old = std::move(value);
      return;
    }
  // By name, as a script's table has no order of its own.
  const auto next = std::find_if(settings.begin(), settings.end(), [&](const auto& s) { return s.first > name; });
  settings.emplace(next, name, std::move(value));
}

void reset(Settings& settings, const std::string& name) {
  std::erase_if(settings, [&](const auto& s) { return s.first == name; });
}

void History::begin(const Choices& first) {
  steps_ = {first};
  present_ = 0;
}

void History::keep(const Choices& now) {
  if (!steps_.empty() && firstDifference(steps_[present_], now) == Step::nothing) return;
  if (!steps_.empty()) steps_.resize(present_ + 1);
  steps_.push_back(now);
  present_ = steps_.size() - 1;
}

}  // namespace pectora::view
