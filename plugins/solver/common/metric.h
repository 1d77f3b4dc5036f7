// Guesses of the inverse Hessian, which speed up minimisers and conjugate gradients.
#pragma once

#include "kernel/physics/system.h"

namespace pectora {

/// A guess of the inverse Hessian.
class Metric {
 public:
  virtual ~Metric() = default;
  /// Fits it to a place; called when a minimisation begins. Returns whether it changed.
  virtual bool refresh(const NodeVectors& positions) = 0;
  /// d = M^-1 g for the free nodes. Both end with the grid of layers, or the free nodes if those are more.
  virtual void apply(const SingleVectors& g, SingleVectors& d) const = 0;
  /// As Session::takeOver.
  virtual void takeOver(Metric& /*before*/) {}
};

/// The inverse 3 x 3 blocks of the projected Hessian's diagonal where all terms have one, else the inverse of the
/// stiffness bound. The system must outlive it.
std::unique_ptr<Metric> makeBlockJacobi(const System& system);

}  // namespace pectora
