#include "plugins/solver/common/lbfgs.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace pectora {

// The two loops: direction = -(approximate inverse Hessian) gradient.
void Lbfgs::findDirection(const NodeVectors& gradient, std::size_t free) {
  std::vector<double> alpha(pairs_.size());
  for (std::size_t i = 0; i < free; ++i) q_.x[i] = float(-gradient.x[i]), q_.y[i] = float(-gradient.y[i]), q_.z[i] = float(-gradient.z[i]);
  for (std::size_t k = pairs_.size(); k-- > 0;) {
    alpha[k] = pairs_[k].inverseSy * dot(pairs_[k].s, q_, free);
    axpy(-alpha[k], pairs_[k].y, q_, free);
  }
  metric_->apply(q_, direction_);
  axpy(scale_ - 1, direction_, direction_, free);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const double beta = pairs_[k].inverseSy * dot(pairs_[k].y, direction_, free);
    axpy(alpha[k] - beta, pairs_[k].s, direction_, free);
  }
}

// Keeps the last step if the curvature along it is positive. The oldest pair gives its room.
void Lbfgs::remember(double step, const NodeVectors& gradientBefore, const NodeVectors& gradient, std::size_t free) {
  Pair pair;
  if (pairs_.size() == memory_) {
    pair = std::move(pairs_.front());
    pairs_.pop_front();
  } else {
    pair = {SingleVectors(free), SingleVectors(free), 0};
  }
  for (auto [s, d] : {std::pair{&pair.s.x, &direction_.x}, {&pair.s.y, &direction_.y}, {&pair.s.z, &direction_.z}})
    for (std::size_t i = 0; i < free; ++i) (*s)[i] = float(step) * (*d)[i];
  for (auto [y, after, before] : {std::tuple{&pair.y.x, &gradient.x, &gradientBefore.x}, {&pair.y.y, &gradient.y, &gradientBefore.y},
                                  {&pair.y.z, &gradient.z, &gradientBefore.z}})
    for (std::size_t i = 0; i < free; ++i) (*y)[i] = float((*after)[i] - (*before)[i]);
  const double sy = dot(pair.s, pair.y, free), yy = dot(pair.y, pair.y, free), ss = dot(pair.s, pair.s, free);
  if (!(sy > 1e-10 * std::sqrt(ss * yy))) return;
  pair.inverseSy = 1 / sy;
  // The metric's scale is that of the last step: s.y / y.(M^-1 y) (Nocedal and Wright, 7.20).
  for (auto [q, y] : {std::pair{&q_.x, &pair.y.x}, {&q_.y, &pair.y.y}, {&q_.z, &pair.y.z}}) std::copy(y->begin(), y->end(), q->begin());
  metric_->apply(q_, direction_);
  scale_ = sy / dot(pair.y, direction_, free);
  pairs_.push_back(std::move(pair));
}

Outcome Lbfgs::minimise(const Objective& objective, NodeVectors& x, Evaluation& e, Limits limits, int& iterations, const Watch& watch) {
  const System& system = objective.system();
  const std::size_t free = system.freeNodes;
  Trial trial;
  objective.evaluate(x, e);
  if (!std::isfinite(e.value) || !std::isfinite(e.residual.force)) return Outcome::diverged;
  q_ = direction_ = SingleVectors(std::max(free, system.anchorNode(0)));
  if (metric_->refresh(x)) pairs_.clear(), scale_ = 1;
  double before = 0, shrinkBefore = 0.95;   // the longest way of a node in the last step, and how that shrank
  for (int n = 0; n < limits.iterations; ++n) {
    watch.iteration(e);
    if (e.isWithin(limits.tolerance)) return Outcome::converged;
    ++iterations;
    findDirection(e.gradient, free);
    const double step = searchLine(objective, x, e, direction_, 1, trial);
    if (step == 0) {
      // What it remembers misleads here: begin anew. From the metric alone, no way down is the end.
      if (pairs_.empty()) return Outcome::stalled;
      pairs_.clear();
      scale_ = 1;
      metric_->refresh(x);
      continue;
    }
    const double way = step * longest(direction_, free), shrink = before > 0 ? std::clamp(way / before, 0.5, 0.95) : 0.95;
    remember(step, trial.evaluation.gradient, e.gradient, free);   // the search left the old place in the trial's room
    // Steps that shrink by r leave r / (1 - r) of the last one to go; of the last two ratios the worse one counts.
    const double worse = std::max(shrink, shrinkBefore);
    if (way * worse / (1 - worse) <= limits.accuracy) return Outcome::converged;
    shrinkBefore = shrink;
    before = way;
  }
  watch.iteration(e);
  return e.isWithin(limits.tolerance) ? Outcome::converged : Outcome::stalled;
}

}  // namespace pectora
