// Implicit steps in time, each the minimum of E(x) + 1/2 sum w_i |x_i - y_i|^2 with y from the steps before. With damping c,
// v' = (a x - s) and a v - u = F / m - c v give w = m a (a + c) and y = ((a + c) s + u) / (a (a + c)), where
//   backward Euler: a = 1 / h,      s = x_n / h,                      u = v_n / h                        (order 1),
//   BDF2:           a = 3 / (2 h),  s = (4 x_n - x_{n-1}) / (2 h),    u = (4 v_n - v_{n-1}) / (2 h)      (order 2).
#pragma once

#include "plugins/solver/common/newton.h"

namespace pectora {

enum class ImplicitScheme { backwardEuler, bdf2 };

class ImplicitStepper {
 public:
  /// Begins with no velocity; `mass` of the free nodes in kg, `step` in s, `damping` c in 1/s. Every term of the system must
  /// have a Hessian; the system outlives this.
  ImplicitStepper(const System& system, std::vector<double> mass, NodeVectors start, double step, double damping, ImplicitScheme scheme);

  /// One step. Driven nodes of positions() may be moved before it. BDF2 makes its first by backward Euler.
  /// On divergence the positions stay as they were.
  Outcome step(Minimiser::Limits limits, const Watch& watch);

  NodeVectors& positions() { return now_; }
  const NodeVectors& positions() const { return now_; }
  const NodeVectors& velocity() const { return velocity_; }
  /// Forces and energy without inertia at the present place.
  const Evaluation& evaluateRest();
  int newtonIterations() const { return iterations_; }
  int evaluations() const { return objective_.evaluations() + rest_.evaluations(); }

 private:
  void aim(bool isBdf2);

  const System& system_;
  std::vector<double> mass_;
  double step_, damping_;
  ImplicitScheme scheme_;
  Objective objective_, rest_;
  Newton newton_;
  Inertia inertia_;
  Evaluation inner_, atRest_;
  NodeVectors now_, before_, velocity_, velocityBefore_;
  int iterations_ = 0, steps_ = 0;
};

}  // namespace pectora
