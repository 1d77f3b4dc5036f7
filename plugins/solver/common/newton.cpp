#include "plugins/solver/common/newton.h"

#include <algorithm>
#include <cmath>

namespace pectora {

Newton::Newton(const System& system)
    : hessian_(makeHessian(system)), metric_(system.rest.size()), direction_(system.rest.size()), r_(direction_), z_(direction_),
      p_(direction_), hp_(direction_) {}

bool Newton::isFor(const System& system) {
  return std::all_of(system.terms.begin(), system.terms.end(), [](const auto& term) { return term->hasHessian(); });
}

void Newton::linearise(const Objective& objective, const NodeVectors& x, bool projected) {
  hessian_->linearise(x, projected);
  std::fill(metric_.begin(), metric_.end(), Symmetric3{});
  hessian_->addDiagonal(metric_);
  for (std::size_t i = 0; i < objective.system().freeNodes; ++i) {
    if (objective.inertia()) metric_[i].addIdentity(objective.inertia()->weight[i]);
    metric_[i] = inverse(metric_[i]);
  }
}

// Conjugate gradients for H d = -g. Where the model falls along a direction without end (it is a ridge or a saddle), that
// direction is taken as far as if the curvature had the other sign, and is the last: d always leads down.
void Newton::solve(const Objective& objective, const NodeVectors& gradient, double forcing, const std::function<void()>& poll) {
  const std::size_t free = objective.system().freeNodes;
  const auto applyMetric = [&] {
    for (std::size_t i = 0; i < free; ++i) z_.set(i, metric_[i] * r_[i]);
  };
  direction_.clear();
  p_.clear();
  for (std::size_t i = 0; i < free; ++i) r_.set(i, -gradient[i]);
  applyMetric();
  scaleAndAdd(z_, 0, p_, free);
  double rz = dot(r_, z_, free);
  const double target = forcing * forcing * rz;
  const int most = int(std::min<std::size_t>(3 * free + 10, 2000));
  for (int n = 0; n < most && rz > target; ++n) {
    if (n % 16 == 15) poll();
    hp_.clear();
    hessian_->multiply(p_, hp_);
    ++products_;
    if (const Inertia* inertia = objective.inertia())
      for (std::size_t i = 0; i < free; ++i) hp_.add(i, p_[i] * inertia->weight[i]);
    const double curvature = dot(p_, hp_, free);
    if (!(curvature > 1e-14 * rz)) {
      axpy(rz / std::max(-curvature, 1e-2 * rz), p_, direction_, free);
      return;
    }
    const double step = rz / curvature;
    axpy(step, p_, direction_, free);
    axpy(-step, hp_, r_, free);
    applyMetric();
    const double next = dot(r_, z_, free);
    scaleAndAdd(z_, next / rz, p_, free);
    rz = next;
  }
}

void Newton::predict(const Objective& objective, const NodeVectors& x, NodeVectors& next, const std::function<void()>& poll) {
  linearise(objective, x, true);
  NodeVectors moved(x.size()), force(x.size());
  for (std::size_t i = objective.system().freeNodes; i < x.size(); ++i) moved.set(i, next[i] - x[i]);
  hessian_->multiply(moved, force);
  solve(objective, force, 1e-2, poll);
  axpy(1, direction_, next, objective.system().freeNodes);
}

Outcome Newton::minimise(const Objective& objective, NodeVectors& x, Evaluation& e, Limits limits, int& iterations, const Watch& watch) {
  const std::size_t free = objective.system().freeNodes;
  Evaluation trial;
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
    if (searchLine(objective, x, e, direction_, 1, trial) > 0) continue;
    if (!projected) {
      trueBelow = 0.1 * e.relativeResidual();
      continue;
    }
    // Down the metric's steepest descent, and no way down at all is the end.
    for (std::size_t i = 0; i < free; ++i) direction_.set(i, metric_[i] * -e.gradient[i]);
    if (searchLine(objective, x, e, direction_, 1, trial) == 0) return e.isWithin(limits.tolerance) ? Outcome::converged : Outcome::stalled;
  }
  watch.iteration(e);
  return e.isWithin(limits.tolerance) ? Outcome::converged : Outcome::stalled;
}

}  // namespace pectora
