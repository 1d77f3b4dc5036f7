#include "plugins/solver/common/lbfgs.h"

#include <algorithm>
#include <cmath>

namespace pectora {

namespace {

// What is left of the way is the inverse Hessian times the gradient. The metric's is too short: on fine walls by 2.7 as a rule, by 5.3 in one
// of ten.
constexpr double kMetricsError = 4;
// A step tells nothing if the gradient has changed along it by less than this part of what the metric expects.
constexpr double kLeastCurvature = 1e-8;

}  // namespace

Lbfgs::Lbfgs(std::shared_ptr<Metric> metric, std::size_t memory)
    : metric_(std::move(metric)), memory_(memory), sy_(memory, memory), yMy_(memory, memory), sg_(memory), yMg_(memory) {}

// From the metric alone.
void Lbfgs::forget() {
  pairs_.clear();
  scale_ = 1;
}

void Lbfgs::dropOldest() {
  const Eigen::Index left = Eigen::Index(pairs_.size()) - 1;
  for (Eigen::MatrixXd* products : {&sy_, &yMy_}) products->topLeftCorner(left, left) = products->block(1, 1, left, left).eval();
  for (Eigen::VectorXd* products : {&sg_, &yMg_}) products->head(left) = products->segment(1, left).eval();
  pairs_.pop_front();
}

void Lbfgs::applyMetric(const NodeVectors& gradient, std::size_t free) {
  copy(gradient, single_, free);
  metric_->apply(single_, metricGradient_);
}

void Lbfgs::project(std::size_t free) {
  std::vector<const SingleVectors*> vectors;
  for (const Pair& pair : pairs_) vectors.insert(vectors.end(), {&pair.s, &pair.my});
  const std::vector<double> products = dots(vectors, single_, free);
  for (std::size_t k = 0; k < pairs_.size(); ++k) sg_[Eigen::Index(k)] = products[2 * k], yMg_[Eigen::Index(k)] = products[2 * k + 1];
}

// The two loops: direction = -(approximate inverse Hessian) gradient.
void Lbfgs::findDirection(std::size_t free) {
  const Eigen::Index count = Eigen::Index(pairs_.size());
  Eigen::VectorXd alpha(count), part(count);   // the direction is made of `part` of every s
  for (Eigen::Index k = count; k-- > 0;) {
    const Eigen::Index newer = count - k - 1;
    alpha[k] = (sg_[k] - sy_.row(k).segment(k + 1, newer).dot(alpha.tail(newer))) / sy_(k, k);
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    const double yr = scale_ * (yMg_[k] - yMy_.col(k).head(count).dot(alpha)) + sy_.col(k).head(k).dot(part.head(k));
    part[k] = alpha[k] - yr / sy_(k, k);
  }
  std::vector<Scaled> sum{{-scale_, &metricGradient_}};
  for (Eigen::Index k = 0; k < count; ++k)
    sum.insert(sum.end(), {{scale_ * alpha[k], &pairs_[std::size_t(k)].my}, {-part[k], &pairs_[std::size_t(k)].s}});
  setSum(sum, direction_, free);
}

// Keeps the last step if the curvature along it is positive; the oldest pair gives its room. What the metric makes of a change is the change
// of what it makes of the gradient.
void Lbfgs::remember(double step, const NodeVectors& gradientBefore, const NodeVectors& gradient, std::size_t free) {
  Pair pair;
  if (pairs_.size() == memory_) {
    pair = std::move(pairs_.front());
    dropOldest();
  } else {
    pair = {SingleVectors(direction_.size()), SingleVectors(direction_.size())};
  }
  std::swap(pair.s, direction_);
  if (step != 1) setSum({{step, &pair.s}}, pair.s, free);
  std::swap(pair.my, metricGradient_);
  applyMetric(gradient, free);
  setSum(metricGradient_, -1, pair.my, pair.my, free);

  // y is known by its products alone: those with the gradient after the step less those with the one before.
  const Eigen::Index last = Eigen::Index(pairs_.size());
  sg_[last] = dot(gradientBefore, pair.s, free), yMg_[last] = dot(gradientBefore, pair.my, free);
  const Eigen::VectorXd sgBefore = sg_.head(last + 1), yMgBefore = yMg_.head(last + 1);
  pairs_.push_back(std::move(pair));
  project(free);
  sy_.col(last).head(last + 1) = sg_.head(last + 1) - sgBefore;
  yMy_.col(last).head(last + 1) = yMg_.head(last + 1) - yMgBefore;
  yMy_.row(last).head(last) = yMy_.col(last).head(last);
  if (!(sy_(last, last) > kLeastCurvature * yMy_(last, last))) {
    pairs_.pop_back();
    return;
  }
  // The metric's scale is that of the last step: s.y / y.(M y) (Nocedal and Wright, 7.20).
  scale_ = sy_(last, last) / yMy_(last, last);
}

Outcome Lbfgs::minimise(const Objective& objective, NodeVectors& x, Evaluation& e, Limits limits, int& iterations, const Watch& watch) {
  const System& system = objective.system();
  const std::size_t free = system.freeNodes;
  Trial trial(x);
  objective.evaluate(x, e);
  if (!std::isfinite(e.value) || !std::isfinite(e.residual.force)) return Outcome::diverged;
  if (const std::size_t nodes = std::max(free, system.anchorNode(0)); single_.size() != nodes) single_ = direction_ = metricGradient_ = SingleVectors(nodes);
  if (metric_->refresh(x)) forget();
  applyMetric(e.gradient, free);
  project(free);
  for (int n = 0; n < limits.iterations; ++n) {
    watch.iteration(e);
    if (e.isWithin(limits.tolerance)) return Outcome::converged;
    ++iterations;
    findDirection(free);
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
