// Limited-memory BFGS (Nocedal and Wright, Numerical Optimization, algorithm 7.4) with a metric M of one's own as the first
// guess of the inverse Hessian. The two loops run over products alone, so that an iteration reads what it remembers but twice: once for its
// products with the gradient, once for the direction (Chen, Wang and Zhou, Large-scale L-BFGS using MapReduce, 2014).
#pragma once

#include "plugins/solver/common/metric.h"
#include "plugins/solver/common/objective.h"

#include <Eigen/Core>

#include <deque>

namespace pectora {

class Lbfgs final : public Minimiser {
 public:
  /// `memory`: how many steps it remembers, also from one minimisation to the next while the metric stays the same.
  Lbfgs(std::shared_ptr<Metric> metric, std::size_t memory);
  Outcome minimise(const Objective& objective, NodeVectors& x, Evaluation& e, Limits limits, int& iterations, const Watch& watch) override;

 private:
  // One step remembered, with y the change of the gradient.
  struct Pair {
    SingleVectors s, my;   // change of place, and M y
  };
  void forget();
  void dropOldest();
  void applyMetric(const NodeVectors& gradient, std::size_t free);
  void project(std::size_t free);
  void findDirection(std::size_t free);
  void remember(double step, const NodeVectors& gradientBefore, const NodeVectors& gradient, std::size_t free);

  std::shared_ptr<Metric> metric_;
  std::size_t memory_;
  std::deque<Pair> pairs_;
  // Products between pairs, by age: s_i . y_j for i <= j, and y_i . M y_j; and those of s and M y with the gradient.
  Eigen::MatrixXd sy_, yMy_;
  Eigen::VectorXd sg_, yMg_;
  double scale_ = 1;   // of the metric
  SingleVectors single_, direction_;   // the gradient that the metric was last applied to, and where to go
  SingleVectors metricGradient_;       // M gradient; the metric is applied once an iteration
};

}  // namespace pectora
