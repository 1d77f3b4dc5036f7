#include "plugins/solver/common/lbfgs.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace pectora {

namespace {

// What is left of the way is the inverse Hessian times the gradient. The metric may make it too short by this factor.
constexpr double kMetricsError = 4;

void copy(const NodeVectors& from, SingleVectors& to, std::size_t count) {
  for (auto [v, w] : {std::pair{&from.x, &to.x}, {&from.y, &to.y}, {&from.z, &to.z}})
    for (std::size_t i = 0; i < count; ++i) (*w)[i] = float((*v)[i]);
}

}  // namespace

// From the metric alone.
void Lbfgs::forget() {
  pairs_.clear();
  scale_ = 1;
}

void Lbfgs::applyMetric(const NodeVectors& gradient, std::size_t free) {
  copy(gradient, q_, free);
  metric_->apply(q_, metricGradient_);
}

// The two loops: direction = -(approximate inverse Hessian) gradient. What the metric makes of the vector between them is put together
// from what it made of its parts.
void Lbfgs::findDirection(const NodeVectors& gradient, std::size_t free) {
  std::vector<double> alpha(pairs_.size());
  copy(gradient, q_, free);
  direction_ = metricGradient_;
  for (std::size_t k = pairs_.size(); k-- > 0;) {
    alpha[k] = pairs_[k].inverseSy * dot(pairs_[k].s, q_, free);
    axpy(-alpha[k], pairs_[k].y, q_, free);
    axpy(-alpha[k], pairs_[k].my, direction_, free);
  }
  axpy(-scale_ - 1, direction_, direction_, free);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const double beta = pairs_[k].inverseSy * dot(pairs_[k].y, direction_, free);
    axpy(-alpha[k] - beta, pairs_[k].s, direction_, free);
  }
}

// Keeps the last step if the curvature along it is positive. The oldest pair gives its room.
void Lbfgs::remember(double step, const NodeVectors& gradientBefore, const NodeVectors& gradient, std::size_t free) {
  std::swap(metricGradient_, spare_);
  applyMetric(gradient, free);
  Pair pair;
  if (pairs_.size() == memory_) {
    pair = std::move(pairs_.front());
    pairs_.pop_front();
  } else {
    pair = {SingleVectors(free), SingleVectors(free), SingleVectors(free), 0};
  }
  for (auto [s, d] : {std::pair{&pair.s.x, &direction_.x}, {&pair.s.y, &direction_.y}, {&pair.s.z, &direction_.z}})
    for (std::size_t i = 0; i < free; ++i) (*s)[i] = float(step) * (*d)[i];
  for (auto [y, after, before] : {std::tuple{&pair.y.x, &gradient.x, &gradientBefore.x}, {&pair.y.y, &gradient.y, &gradientBefore.y},
                                  {&pair.y.z, &gradient.z, &gradientBefore.z}})
    for (std::size_t i = 0; i < free; ++i) (*y)[i] = float((*after)[i] - (*before)[i]);
  for (auto [y, after, before] : {std::tuple{&pair.my.x, &metricGradient_.x, &spare_.x}, {&pair.my.y, &metricGradient_.y, &spare_.y},
                                  {&pair.my.z, &metricGradient_.z, &spare_.z}})
    for (std::size_t i = 0; i < free; ++i) (*y)[i] = (*after)[i] - (*before)[i];
  const double sy = dot(pair.s, pair.y, free), yy = dot(pair.y, pair.y, free), ss = dot(pair.s, pair.s, free);
  if (!(sy > 1e-10 * std::sqrt(ss * yy))) return;
  pair.inverseSy = 1 / sy;
  // The metric's scale is that of the last step: s.y / y.(M^-1 y) (Nocedal and Wright, 7.20).
  scale_ = sy / dot(pair.y, pair.my, free);
  pairs_.push_back(std::move(pair));
}

Outcome Lbfgs::minimise(const Objective& objective, NodeVectors& x, Evaluation& e, Limits limits, int& iterations, const Watch& watch) {
  const System& system = objective.system();
  const std::size_t free = system.freeNodes;
  Trial trial;
  objective.evaluate(x, e);
  if (!std::isfinite(e.value) || !std::isfinite(e.residual.force)) return Outcome::diverged;
  if (const std::size_t nodes = std::max(free, system.anchorNode(0)); q_.size() != nodes) q_ = direction_ = metricGradient_ = spare_ = SingleVectors(nodes);
  if (metric_->refresh(x)) forget();
  applyMetric(e.gradient, free);
  for (int n = 0; n < limits.iterations; ++n) {
    watch.iteration(e);
    if (e.isWithin(limits.tolerance)) return Outcome::converged;
    ++iterations;
    findDirection(e.gradient, free);
    const double step = searchLine(objective, x, e, direction_, 1, trial);
    if (step == 0) {
      // What it remembers misleads here: begin anew. From the metric alone, no way down is the end.
      if (pairs_.empty()) return Outcome::stalled;
      metric_->refresh(x);
      forget();
      applyMetric(e.gradient, free);
      continue;
    }
    remember(step, trial.evaluation.gradient, e.gradient, free);   // the search left the old place in the trial's room
    if (kMetricsError * scale_ * longest(metricGradient_, free) <= limits.accuracy) return Outcome::converged;
  }
  watch.iteration(e);
  return e.isWithin(limits.tolerance) ? Outcome::converged : Outcome::stalled;
}

}  // namespace pectora
