// Position Verlet with velocity damping (Moreira et al., SPIE 2012, equations 1-3):
//   F = k (|d| - l0) d / |d|,   a = F / m - c (x_n - x_{n-1}) / h,   x_{n+1} = 2 x_n - x_{n-1} + h^2 a.
#pragma once

#include "kernel/physics/system.h"

namespace pectora {

/// Squared upper bound of the system's angular frequencies, 1/s^2: the largest over the nodes of stiffness bound over mass
/// (Gershgorin), with masses in kg and stiffness in N/mm.
double frequencyBoundSquared(const System& system, const std::vector<double>& mass);

/// The largest stable step, s, of the scheme with its lagged damping: (2 / w) (sqrt(1 + z^2) - z) with z = c / (2 w),
/// for the angular frequency bound w (1/s) and damping c (1/s).
double stableStep(double frequencyBound, double damping);

/// The integrator: positions of all nodes at two times.
class Verlet {
 public:
  /// `mass` of the free nodes in kg. The first step starts from rest with the order of the scheme:
  /// x(-h) = x0 + h^2 a0 / 2.
  Verlet(const System& system, std::vector<double> mass, NodeVectors start, double step);

  /// One step of length h with damping c, 1/s. Driven nodes of positions() may be moved between steps.
  void step(double damping);

  NodeVectors& positions() { return now_; }
  const NodeVectors& positions() const { return now_; }
  /// Of the positions before the last step: gradient (N), energy (N mm), the largest single spring force (N).
  const NodeVectors& gradient() const { return gradient_; }
  double energy() const { return energy_; }
  double largestForce() const { return largestForce_; }
  /// Stiffness of the present motion as seen by its change of force, 1/s^2 (Rayleigh quotient, Underwood 1983); 0 if it does
  /// not move. Valid from the second step on.
  double rayleighQuotient() const { return rayleigh_; }
  int evaluations() const { return evaluations_; }

 private:
  void evaluate();
  const System& system_;
  std::vector<double> mass_;
  double step_;
  NodeVectors now_, before_, gradient_, gradientBefore_;
  double energy_ = 0, largestForce_ = 0, rayleigh_ = 0;
  int evaluations_ = 0;
  bool started_ = false;
};

}  // namespace pectora
