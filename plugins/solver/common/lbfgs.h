// Limited-memory BFGS (Nocedal and Wright, Numerical Optimization, algorithm 7.4) with a metric of one's own as the first
// guess of the inverse Hessian.
#pragma once

#include "plugins/solver/common/metric.h"
#include "plugins/solver/common/objective.h"

#include <deque>

namespace pectora {

class Lbfgs final : public Minimiser {
 public:
  /// `memory`: how many steps it remembers, also from one minimisation to the next while the metric stays the same.
  Lbfgs(std::shared_ptr<Metric> metric, std::size_t memory) : metric_(std::move(metric)), memory_(memory) {}
  Outcome minimise(const Objective& objective, NodeVectors& x, Evaluation& e, Limits limits, int& iterations, const Watch& watch) override;

 private:
  // One step remembered: s = change of place, y = change of gradient, my = M^-1 y.
  struct Pair {
    SingleVectors s, y, my;
    double inverseSy;
  };
  void forget();
  void applyMetric(const NodeVectors& gradient, std::size_t free);
  void findDirection(const NodeVectors& gradient, std::size_t free);
  void remember(double step, const NodeVectors& gradientBefore, const NodeVectors& gradient, std::size_t free);

  std::shared_ptr<Metric> metric_;
  std::size_t memory_;
  std::deque<Pair> pairs_;
  double scale_ = 1;   // of the metric
  SingleVectors q_, direction_;
  SingleVectors metricGradient_, spare_;   // M^-1 gradient, and that of the place before: the metric is applied once an iteration
};

}  // namespace pectora
