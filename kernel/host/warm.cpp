#include "kernel/host/warm.h"

#include <fmt/format.h>

namespace pectora {
namespace {

// Refuses the first effect that cannot give what the solver uses.
void checkNeeds(const std::string& solver, const Needs& needs, const std::vector<EffectUse>& effects) {
  for (const EffectUse& use : effects) {
    const char* missing = needs.hessian && !use.hasHessian ? "a Hessian" : needs.springs && !use.hasSprings ? "springs alone" : nullptr;
    if (!missing) continue;
    throw Error(fmt::format("{} works only with effects that offer {}, and {} does not", solver, missing, use.id))
        .of("scene").advise(fmt::format("Take a solver that uses gradients alone, such as solver.verlet or solver.lbfgs, or leave {} out of the scene", use.id));
  }
}

}  // namespace

WarmSolve::WarmSolve(std::shared_ptr<const Scene> scene, std::string id, std::unique_ptr<Solver> solver, Registry& registry, Host& host)
    : scene_(std::move(scene)), solver_(std::move(solver)), compiled_(compile(*scene_, registry)) {
  for (const EffectUse& use : compiled_.effects)
    if (!use.isActive) host.info(use.id + " drops out: " + use.reason);
  checkNeeds(id, solver_->needs(), compiled_.effects);
}

void WarmSolve::startFrom(const Motion& motion) {
  const std::size_t layer = scene_->points();
  if (motion.outer.size() != layer || motion.anchors.size() != scene_->anchors.size())
    throw Error("the motion to start from belongs to another scene").of("start")
        .given(fmt::format("{} points, {} anchors", motion.outer.size(), motion.anchors.size()))
        .allowed(fmt::format("{} points, {} anchors", layer, scene_->anchors.size()));
  start_ = compiled_.system->rest;
  for (std::size_t i = 0; i < layer; ++i) start_.set(i, motion.outer[i]), start_.set(layer + i, motion.inner[i]);
  for (std::size_t j = 0; j < motion.anchors.size(); ++j) start_.set(2 * layer + j, motion.anchors[j]);
}

void WarmSolve::startFrom(NodeVectors positions) { start_ = std::move(positions); }

std::shared_ptr<const Motion> WarmSolve::solve(const Plan& plan, Host& host) {
  if (!session_) session_ = solver_->prepare(*compiled_.system, host);
  const Drive drive = makeDrive(*scene_, plan);
  Solution solution = session_->solve(drive, start_.size() ? &start_ : nullptr, host);

  auto motion = std::make_shared<Motion>();
  const std::size_t layer = scene_->points();
  motion->scene = scene_;
  motion->outer.reserve(layer);
  motion->inner.reserve(layer);
  for (std::size_t i = 0; i < layer; ++i) {
    motion->outer.push_back(solution.positions[i]);
    motion->inner.push_back(solution.positions[layer + i]);
  }
  motion->anchors = drive.frames.back();
  motion->status = solution.status;
  motion->message = std::move(solution.message);
  motion->iterations = solution.iterations;
  motion->forceEvaluations = solution.forceEvaluations;
  motion->residual = solution.residual;
  motion->relativeResidual = solution.relativeResidual;
  motion->energy = solution.energy;
  motion->energyHistory = std::move(solution.energyHistory);
  motion->invertedPrisms = countInvertedPrisms(scene_->rows, scene_->columns, motion->outer, motion->inner, motion->invertedAt);
  if (solution.status != SolveStatus::diverged) start_ = std::move(solution.positions);
  return motion;
}

}  // namespace pectora
