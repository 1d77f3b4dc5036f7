#include "plugins/solver/common/newton.h"

#include <algorithm>
#include <cmath>

namespace pectora {

Newton::Newton(const System& system, std::shared_ptr<Metric> metric)
    : hessian_(makeHessian(system)), metric_(std::move(metric)), direction_(system.rest.size()) {
  if (metric_) single_ = ConjugateGradients<SingleVectors>(std::max(system.freeNodes, system.anchorNode(0)));
}

bool Newton::usesMetric(const Objective& objective) const { return metric_ && !objective.inertia(); }

bool Newton::isFor(const System& system) {
  return std::all_of(system.terms.begin(), system.terms.end(), [](const auto& term) { return term->hasHessian(); });
}

void Newton::linearise(const Objective& objective, const NodeVectors& x, bool projected) {
  hessian_->linearise(x, projected);
  if (usesMetric(objective)) {
    metric_->refresh(x);
    return;
  }
  if (double_.size() == 0) double_ = ConjugateGradients<NodeVectors>(x.size());
  blocks_.assign(x.size(), {});
  hessian_->addDiagonal(blocks_);
  for (std::size_t i = 0; i < objective.system().freeNodes; ++i) {
    if (objective.inertia()) blocks_[i].addIdentity(objective.inertia()->weight[i]);
    blocks_[i] = inverse(blocks_[i]);
  }
}

void Newton::solve(const Objective& objective, const NodeVectors& gradient, double forcing, const std::function<void()>& poll) {
  const std::size_t free = objective.system().freeNodes;
  if (usesMetric(objective)) {
    single_.solve(
        free, gradient, forcing, [&](const SingleVectors& v, SingleVectors& hv) { hessian_->multiplySingle(v, hv); },
        [&](const SingleVectors& r, SingleVectors& z) { metric_->apply(r, z); }, poll);
    for (std::size_t i = 0; i < free; ++i) direction_.set(i, single_.solution()[i]);
    return;
  }
  double_.solve(
      free, gradient, forcing,
      [&](const NodeVectors& v, NodeVectors& hv) {
        hessian_->multiply(v, hv);
        if (const Inertia* inertia = objective.inertia())
          for (std::size_t i = 0; i < free; ++i) hv.add(i, v[i] * inertia->weight[i]);
      },
      [&](const NodeVectors& r, NodeVectors& z) {
        for (std::size_t i = 0; i < free; ++i) z.set(i, blocks_[i] * r[i]);
      },
      poll);
  direction_ = double_.solution();
}

void Newton::predict(const Objective& objective, const NodeVectors& x, NodeVectors& next, double forcing, const std::function<void()>& poll) {
  linearise(objective, x, true);
  NodeVectors moved(x.size()), force(x.size());
  for (std::size_t i = objective.system().freeNodes; i < x.size(); ++i) moved.set(i, next[i] - x[i]);
  hessian_->multiply(moved, force);
  solve(objective, force, forcing, poll);
  setSum(next, 1, direction_, next, objective.system().freeNodes);
}

Outcome Newton::minimise(const Objective& objective, NodeVectors& x, Evaluation& e, Limits limits, int& iterations, const Watch& watch) {
  const std::size_t free = objective.system().freeNodes;
  Trial trial(x);
  objective.evaluate(x, e);
  if (!std::isfinite(e.value) || !std::isfinite(e.residual.force)) return Outcome::diverged;
  const double firstNorm = std::sqrt(dot(e.gradient, e.gradient, free));
  // The true Hessian once the residual is small; after it misled, once it is ten times smaller than it was then.
  double trueBelow = 1e-2;
  for (int n = 0; n < limits.iterations; ++n) {
    watch.iteration(e);
    if (e.isWithin(limits.tolerance)) return Outcome::converged;
    ++iterations;
    const double forcing = std::min(0.5, std::sqrt(std::sqrt(dot(e.gradient, e.gradient, free)) / firstNorm));
    const bool projected = !e.isWithin(trueBelow);
    linearise(objective, x, projected);
    solve(objective, e.gradient, forcing, watch.poll);
    if (const double step = searchLine(objective, x, e, direction_, 1, trial); step > 0) {
      // The step is half of the way to the minimum at the least, and there is less to go than it was long.
      if (step == 1 && longest(direction_, free) <= limits.accuracy) return Outcome::converged;
      continue;
    }
    if (!projected) {
      trueBelow = 0.1 * e.relativeResidual();
      continue;
    }
    // Down the metric's steepest descent, and no way down at all is the end.
    solve(objective, e.gradient, 1, watch.poll);
    if (searchLine(objective, x, e, direction_, 1, trial) == 0) return e.isWithin(limits.tolerance) ? Outcome::converged : Outcome::stalled;
  }
  watch.iteration(e);
  return e.isWithin(limits.tolerance) ? Outcome::converged : Outcome::stalled;
}

}  // namespace pectora
