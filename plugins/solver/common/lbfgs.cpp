#include "plugins/solver/common/lbfgs.h"

#include "kernel/physics/hessian.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

class BlockJacobi final : public Metric {
 public:
  explicit BlockJacobi(const System& system) : system_(system), hessian_(makeHessian(system)), blocks_(system.rest.size()) {
    if (hessian_) return;
    const std::vector<double> bound = system.stiffnessBound();
    for (std::size_t i = 0; i < bound.size(); ++i) blocks_[i].addIdentity(1 / bound[i]);
  }
  void refresh(const NodeVectors& positions) override {
    if (!hessian_) return;
    hessian_->linearise(positions, true);
    std::fill(blocks_.begin(), blocks_.end(), Symmetric3{});
    hessian_->addDiagonal(blocks_);
    for (std::size_t i = 0; i < system_.freeNodes; ++i) blocks_[i] = inverse(blocks_[i]);
  }
  void apply(const NodeVectors& g, NodeVectors& d) const override {
    for (std::size_t i = 0; i < system_.freeNodes; ++i) d.set(i, blocks_[i] * g[i]);
  }

 private:
  const System& system_;
  std::unique_ptr<Hessian> hessian_;
  std::vector<Symmetric3> blocks_;
};

}  // namespace

std::unique_ptr<Metric> makeBlockJacobi(const System& system) { return std::make_unique<BlockJacobi>(system); }

// The two loops: direction = -(approximate inverse Hessian) gradient.
void Lbfgs::findDirection(const NodeVectors& gradient, std::size_t free) {
  std::vector<double> alpha(pairs_.size());
  q_ = gradient;
  for (std::size_t k = pairs_.size(); k-- > 0;) {
    alpha[k] = pairs_[k].inverseSy * dot(pairs_[k].s, q_, free);
    axpy(-alpha[k], pairs_[k].y, q_, free);
  }
  direction_.clear();
  metric_->apply(q_, direction_);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const double beta = pairs_[k].inverseSy * dot(pairs_[k].y, direction_, free);
    axpy(alpha[k] - beta, pairs_[k].s, direction_, free);
  }
  axpy(-2, direction_, direction_, free);
}

Outcome Lbfgs::minimise(const Objective& objective, NodeVectors& x, Evaluation& e, Limits limits, int& iterations, const Watch& watch) {
  const std::size_t free = objective.system().freeNodes;
  Evaluation trial;
  objective.evaluate(x, e);
  if (!std::isfinite(e.value) || !std::isfinite(e.residual.force)) return Outcome::diverged;
  direction_ = NodeVectors(x.size());
  metric_->refresh(x);
  pairs_.clear();
  for (int n = 0; n < limits.iterations; ++n) {
    watch.iteration(e);
    if (e.isWithin(limits.tolerance)) return Outcome::converged;
    ++iterations;
    findDirection(e.gradient, free);
    const NodeVectors gradient = e.gradient;
    const double step = searchLine(objective, x, e, direction_, 1, trial);
    if (step == 0) {
      // What it remembers misleads here: begin anew. From the metric alone, no way down is the end.
      if (pairs_.empty()) return Outcome::stalled;
      pairs_.clear();
      metric_->refresh(x);
      continue;
    }
    // Remember the step if the curvature along it is positive.
    Pair pair{NodeVectors(x.size()), e.gradient, 0};
    axpy(step, direction_, pair.s, free);
    axpy(-1, gradient, pair.y, free);
    const double sy = dot(pair.s, pair.y, free), yy = dot(pair.y, pair.y, free), ss = dot(pair.s, pair.s, free);
    if (!(sy > 1e-10 * std::sqrt(ss * yy))) continue;
    pair.inverseSy = 1 / sy;
    pairs_.push_back(std::move(pair));
    if (pairs_.size() > memory_) pairs_.pop_front();
  }
  watch.iteration(e);
  return e.isWithin(limits.tolerance) ? Outcome::converged : Outcome::stalled;
}

}  // namespace pectora
