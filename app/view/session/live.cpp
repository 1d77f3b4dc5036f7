#include "app/view/session/live.h"

#include <algorithm>

namespace pectora::view {
namespace {

// A skin that moves need not come nearer than is seen. What settles is solved to the tolerance that was chosen.
Settings loosened(Settings settings, const std::vector<Parameter>& parameters) {
  for (const Parameter& p : parameters) {
    if (p.name != "tolerance") continue;
    const SettingValue* given = find(settings, p.name);
    assign(settings, p.name, std::max(std::get<double>(given ? *given : p.value), kLiveTolerance));
  }
  return settings;
}

}  // namespace

std::unique_ptr<Solver> makeSolver(Registry& registry, const PluginChoice& choice) {
  auto solver = registry.open(choice.id).descriptor->makeSolver();
  applySettings(choice.settings, [&](Visitor& v) { solver->describe(v); });
  return solver;
}

WarmSolve& LiveSolve::ready(const std::shared_ptr<const Scene>& scene, const PluginChoice& solver, const Motion* motion, Host& host) {
  if (warm_ && warm_->scene() == scene && solver_ == solver) return *warm_;
  const auto before = std::move(warm_);
  if (scene->points() >= kFineWall && registry_.has("solver.multigrid")) {
    try {
      const PluginChoice fine{"solver.multigrid", {{"accuracy", kLiveAccuracy}}};
      warm_ = std::make_unique<WarmSolve>(scene, fine.id, makeSolver(registry_, fine), registry_, host);
    } catch (const Error&) {
      // An effect without a Hessian: the chosen solver moves the skin, too, or says why it cannot.
    }
  }
  if (!warm_) {
    auto chosen = registry_.open(solver.id).descriptor->makeSolver();
    const auto describe = [&](Visitor& v) { chosen->describe(v); };
    applySettings(loosened(solver.settings, parameters(describe)), describe);
    warm_ = std::make_unique<WarmSolve>(scene, solver.id, std::move(chosen), registry_, host);
  }
  if (before) warm_->takeOver(*before, host);
  solver_ = solver;
  isWarm_ = false;
  if (motion) startFrom(*motion);
  return *warm_;
}

void LiveSolve::startFrom(const Motion& motion) {
  if (!warm_) return;
  const System& system = *warm_->compiled().system;
  const bool fits = motion.outer.size() == system.points() && int(motion.between.size()) + 2 == system.layers &&
                    motion.anchors.size() == system.rest.size() - system.freeNodes;
  if (fits) warm_->startFrom(motion);
  isWarm_ = isWarm_ || fits;
}

}  // namespace pectora::view
