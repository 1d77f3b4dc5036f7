// Minimisation by projected Newton steps, each solved by conjugate gradients with the inverse 3 x 3 blocks as metric.
#pragma once

#include "plugins/solver/common/conjugate_gradients.h"
#include "plugins/solver/common/metric.h"
#include "plugins/solver/common/objective.h"

#include "kernel/physics/hessian.h"

namespace pectora {

/// Inexact Newton with line search. Far from the minimum the Hessian is projected, so that every direction leads down; near
/// it the true one is used, which converges faster where springs are squeezed. Forcing min(1/2, sqrt(|g| / |g0|))
/// (Eisenstat and Walker 1996; Nocedal and Wright, Numerical Optimization, 7.1).
class Newton final : public Minimiser {
 public:
  /// Every term of the system must have a Hessian. The system outlives this. `metric` speeds up the conjugate gradients of an
  /// objective without inertia; null: the inverse 3 x 3 blocks.
  explicit Newton(const System& system, std::shared_ptr<Metric> metric = nullptr);
  /// Whether they have.
  static bool isFor(const System& system);
  Outcome minimise(const Objective& objective, NodeVectors& x, Evaluation& e, Limits limits, int& iterations, const Watch& watch) override;
  /// Moves the free nodes of `next` as the linear answer to its driven nodes, which have moved since the rest state `x`:
  /// dx = -H_ff^-1 H_fd dx_d, with the projected Hessian and until the error is about `forcing` of it.
  void predict(const Objective& objective, const NodeVectors& x, NodeVectors& next, double forcing, const std::function<void()>& poll);
  /// Products of the Hessian with a vector so far.
  int products() const { return double_.products() + single_.products(); }

 private:
  bool usesMetric(const Objective& objective) const;
  void linearise(const Objective& objective, const NodeVectors& x, bool projected);
  void solve(const Objective& objective, const NodeVectors& gradient, double forcing, const std::function<void()>& poll);

  std::unique_ptr<Hessian> hessian_;
  std::shared_ptr<Metric> metric_;
  std::vector<Symmetric3> blocks_;   // inverse, of the diagonal
  ConjugateGradients<NodeVectors> double_;
  ConjugateGradients<SingleVectors> single_;
  NodeVectors direction_;
};

}  // namespace pectora
