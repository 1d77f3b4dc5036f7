// Preconditioned conjugate gradients for one step of Newton's method.
#pragma once

#include "plugins/solver/common/node_algebra.h"

#include <algorithm>

namespace pectora {

/// Vectors is NodeVectors or SingleVectors. Room is kept from one call to the next.
template <class Vectors>
class ConjugateGradients {
 public:
  explicit ConjugateGradients(std::size_t nodes = 0) : solution_(nodes), r_(nodes), z_(nodes), p_(nodes), hp_(nodes) {}
  std::size_t size() const { return r_.size(); }

  /// Solves H d = -g for nodes [0, free) until the residual's norm in the metric is `forcing` times the first one. Where H
  /// falls along a direction without end (it is a ridge or a saddle), that direction is taken as far as if the curvature had
  /// the other sign, and is the last: d always leads down. multiply(v, y) adds H v to y, metric(r, z) sets z.
  template <class Multiply, class Metric, class Poll>
  void solve(std::size_t free, const NodeVectors& gradient, double forcing, Multiply&& multiply, Metric&& metric, Poll&& poll);

  const Vectors& solution() const { return solution_; }
  /// Products with H so far.
  int products() const { return products_; }

 private:
  Vectors solution_, r_, z_, p_, hp_;
  int products_ = 0;
};

template <class Vectors>
template <class Multiply, class Metric, class Poll>
void ConjugateGradients<Vectors>::solve(std::size_t free, const NodeVectors& gradient, double forcing, Multiply&& multiply,
                                        Metric&& metric, Poll&& poll) {
  solution_.clear();
  p_.clear();
  for (std::size_t i = 0; i < free; ++i) r_.set(i, -gradient[i]);
  metric(r_, z_);
  setSum(z_, 0, z_, p_, free);
  double rz = dot(r_, z_, free);
  const double target = forcing * forcing * rz;
  const int most = int(std::min<std::size_t>(3 * free + 10, 2000));
  for (int n = 0; n < most && rz > target; ++n) {
    if (n % 16 == 15) poll();
    hp_.clear();
    multiply(p_, hp_);
    ++products_;
    const double curvature = dot(p_, hp_, free);
    if (!(curvature > 1e-14 * rz)) {
      setSum(solution_, rz / std::max(-curvature, 1e-2 * rz), p_, solution_, free);
      return;
    }
    const double step = rz / curvature;
    setSum(solution_, step, p_, solution_, free);
    setSum(r_, -step, hp_, r_, free);
    metric(r_, z_);
    const double next = dot(r_, z_, free);
    setSum(z_, next / rz, p_, p_, free);
    rz = next;
  }
}

}  // namespace pectora
