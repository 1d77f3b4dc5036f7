// What the explicit solvers have in common: damped motion in time until the wall is at rest.
#pragma once

#include "kernel/physics/system.h"
#include "kernel/stage/solver.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace pectora {

/// Squared upper bound of the system's angular frequencies, 1/s^2: the largest over the nodes of stiffness bound over mass
/// (Gershgorin), with masses in kg and stiffness in N/mm.
double frequencyBoundSquared(const System& system, const std::vector<double>& mass);

/// The largest stable step, s, of Verlet and of semi-implicit Euler with damping by the last velocity:
/// (2 / w) (sqrt(1 + z^2) - z) with z = c / (2 w), for the angular frequency bound w (1/s) and damping c (1/s).
double stableStep(double frequencyBound, double damping);

/// A system that moves by explicit steps, and what was seen at the place before the last one.
class ExplicitScheme {
 public:
  /// `mass` of the free nodes in kg. `step` in s. The system outlives this.
  ExplicitScheme(const System& system, std::vector<double> mass, NodeVectors start, double step);
  virtual ~ExplicitScheme() = default;

  /// One step with damping c, 1/s. Driven nodes of positions() may be moved between steps.
  void step(double damping);

  NodeVectors& positions() { return now_; }
  const NodeVectors& positions() const { return now_; }
  /// Kinetic energy of the motion into the positions before the last step, N mm.
  double kineticEnergy() const { return kinetic_; }
  /// Of the positions before the last step: gradient (N), energy (N mm), the largest single spring force (N).
  const NodeVectors& gradient() const { return gradient_; }
  double energy() const { return energy_; }
  double largestForce() const { return largestForce_; }
  /// Stiffness of the present motion as seen by its change of force, 1/s^2 (Rayleigh quotient, Underwood 1983); 0 if it does
  /// not move. Valid from the second step on.
  double rayleighQuotient() const { return rayleigh_; }
  int evaluations() const { return evaluations_; }
  /// Velocity at positions(), mm/s, to the second order: that of the last step and half of what the acceleration there adds.
  /// `gradient` is that of the energy at positions().
  NodeVectors velocity(const NodeVectors& gradient, double damping) const;

 protected:
  /// Moves one node at x, which was at `before` one step ago and has the acceleration `free` (mm/s^2) without damping.
  virtual Vec3 advance(Vec3 x, Vec3 before, Vec3 free, double damping, bool isFirst) const = 0;
  double stepLength() const { return step_; }

 private:
  const System& system_;
  std::vector<double> mass_;
  double step_;
  NodeVectors now_, before_, gradient_, gradientBefore_;
  double energy_ = 0, largestForce_ = 0, rayleigh_ = 0, kinetic_ = 0;
  int evaluations_ = 0;
  bool started_ = false;
};

struct RelaxationSettings {
  double timeStep = 0, damping = 0, tolerance = 1e-4;
  int maxIterations = 20000, ramp = 100;
  std::string mass = "scaled";
  void describe(Visitor& v);
};

using MakeScheme = std::function<std::unique_ptr<ExplicitScheme>(const System&, std::vector<double> mass, NodeVectors start, double step)>;
/// A session that steps until rest, or for a scene that asks for it through its motion in time. `scheme` names it in messages. Throws
/// Error for a step beyond its stability limit.
std::unique_ptr<Session> makeRelaxation(const System& system, const RelaxationSettings& settings, const std::string& scheme, MakeScheme make);

}  // namespace pectora
