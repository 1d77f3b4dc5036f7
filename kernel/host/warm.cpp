#include "kernel/host/warm.h"

#include "kernel/host/rest_shape.h"

#include <fmt/format.h>

namespace pectora {
namespace {

// Refuses the first effect that cannot give what the solver uses.
void checkNeeds(const std::string& solver, const Needs& needs, const std::vector<EffectUse>& effects) {
  for (const EffectUse& use : effects) {
    if (needs.rest && use.movesInTime)
      throw Error(fmt::format("{} finds the wall at rest, and {} asks for its motion in time", solver, use.id))
          .of("scene").advise(fmt::format("Take solver.implicit, solver.verlet or solver.semi_implicit, or leave {} out of the scene", use.id));
    const char* missing = needs.hessian && !use.hasHessian ? "a Hessian" : needs.springs && !use.hasSprings ? "springs alone" : nullptr;
    if (!missing) continue;
    throw Error(fmt::format("{} works only with effects that offer {}, and {} does not", solver, missing, use.id))
        .of("scene").advise(fmt::format("Take a solver that uses gradients alone, such as solver.verlet or solver.lbfgs, or leave {} out of the scene", use.id));
  }
}

}  // namespace

WarmSolve::WarmSolve(std::shared_ptr<const Scene> scene, std::string id, std::unique_ptr<Solver> solver, Registry& registry, Host& host)
    : scene_(std::move(scene)), id_(std::move(id)), rest_(scene_), solver_(std::move(solver)), registry_(registry), compiled_(compile(*scene_, registry)) {
  for (const EffectUse& use : compiled_.effects)
    if (!use.isActive) host.info(use.id + " drops out: " + use.reason);
  checkNeeds(id_, solver_->needs(), compiled_.effects);
  if (scene_->still > 0 && !mayLeaveOut()) host.info(fmt::format("all points are computed, as {}", compiled_.isLoadedInCt ? "the weight moves them all" : "what moves in time may spread"));
  if (!compiled_.isLoadedInCt) return;
  if (const auto found = findRestShape(*scene_, *solver_, registry, host)) {
    rest_ = found;
    compiled_ = compile(*rest_, registry);
  } else {
    host.info("no shape of the wall comes to rest as the CT shows it; the loads after the operation, less those of the CT, act on the CT's shape");
    compiled_ = compile(*scene_, registry, CtLoads::countered);
  }
}

void WarmSolve::startFrom(const Motion& motion) {
  const System& system = *compiled_.system;
  const auto counts = [](std::size_t layers, std::size_t points, std::size_t anchors) {
    return fmt::format("{} layers of {} points, {} anchors", layers, points, anchors);
  };
  const std::string given = counts(motion.between.size() + 2, motion.outer.size(), motion.anchors.size());
  const std::string allowed = counts(scene_->between.size() + 2, system.points(), system.rest.size() - system.freeNodes);
  if (given != allowed) throw Error("the motion to start from belongs to another scene").of("start").given(given).allowed(allowed);
  start_ = NodeVectors(system.rest.size());
  for (int l = 0; l < system.layers; ++l)
    for (std::size_t i = 0; i < system.points(); ++i) start_.set(system.node(l, i), motion.layer(l)[i]);
  for (std::size_t j = 0; j < motion.anchors.size(); ++j) start_.set(system.anchorNode(j), motion.anchors[j]);
  for (std::size_t i = 0; i < start_.size(); ++i)
    if (!isFinite(start_[i])) throw Error("a position of the motion to start from is not a finite number").of("start").at(system.nodeName(i));
}

bool WarmSolve::mayLeaveOut() const { return !compiled_.isLoadedInCt && !compiled_.system->dynamics.isAskedFor(); }

void WarmSolve::startFrom(NodeVectors positions) { start_ = std::move(positions); }

void WarmSolve::takeOver(WarmSolve& before, Host& host) {
  if (before.id_ != id_ || !before.session_) return;
  prepare(host);
  if (session_) session_->takeOver(*before.session_);
}

void WarmSolve::prepare(Host& host) {
  if (session_ || region_) return;
  if (scene_->still > 0 && mayLeaveOut()) region_ = std::make_unique<RegionSolve>(*rest_, *compiled_.system, scene_->still, *solver_, registry_);
  else session_ = solver_->prepare(*compiled_.system, host);
}

std::shared_ptr<const Motion> WarmSolve::solve(const Plan& plan, Host& host) {
  prepare(host);
  const NodeVectors* start = start_.size() ? &start_ : nullptr;
  const Drive drive = start ? makeDriveEnd(*rest_, compiled_, plan) : makeDrive(*rest_, compiled_, plan);
  Solution solution = region_ ? region_->solve(plan, drive, start, host) : session_->solve(drive, start, host);

  auto motion = std::make_shared<Motion>();
  const System& system = *compiled_.system;
  motion->scene = scene_;
  const auto layerOf = [&](int l) {
    std::vector<Vec3> layer;
    layer.reserve(system.points());
    for (std::size_t i = 0; i < system.points(); ++i) layer.push_back(solution.positions[system.node(l, i)]);
    return layer;
  };
  motion->outer = layerOf(0);
  for (int l = 1; l + 1 < system.layers; ++l) motion->between.push_back(layerOf(l));
  motion->inner = layerOf(system.layers - 1);
  motion->anchors = drive.frames.back();
  const BarLoad load = shareLift(compiled_, plan);
  motion->lift = load.part * plan.lift();
  motion->barForces = load.forces;
  motion->status = solution.status;
  motion->message = std::move(solution.message);
  motion->iterations = solution.iterations;
  motion->forceEvaluations = solution.forceEvaluations;
  motion->residual = solution.residual;
  motion->relativeResidual = solution.relativeResidual;
  motion->energy = solution.energy;
  motion->energyGrowth = solution.energyGrowth;
  motion->energyHistory = std::move(solution.energyHistory);
  motion->moments = std::move(solution.moments);
  for (int l = 0; l + 1 < system.layers; ++l) {
    int first = -1;
    motion->invertedPrisms += countInvertedPrisms(scene_->rows, scene_->columns, motion->layer(l), motion->layer(l + 1), first);
    if (motion->invertedAt < 0) motion->invertedAt = first;
  }
  if (solution.status != SolveStatus::diverged) start_ = std::move(solution.positions);
  return motion;
}

}  // namespace pectora
