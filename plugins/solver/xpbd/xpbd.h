// Extended position-based dynamics with small steps (Macklin et al., SCA 2019): each step moves all nodes on, then turns to every
// spring once, in order, and moves its ends by
//   C = l - l0,   dl = -C / (w_a + w_b + 1 / (k h^2)),   x_a -= w_a dl n,   x_b += w_b dl n.
// At rest a spring then acts with k / (1 + k h^2 (w_a + w_b)) and sees its neighbours half moved: the end lies off the least
// energy by the order of h^2.
#pragma once

#include "kernel/physics/system.h"

namespace pectora {

class Xpbd {
 public:
  /// Nodes weigh in proportion to their stiffness, so that the fastest mode has an angular frequency of at most 1. All terms
  /// are springs or forces that never change; the system outlives this.
  Xpbd(const System& system, NodeVectors start);

  /// One step of length h, in units of the inverse of that frequency. Driven nodes of positions() may be moved before it.
  /// When the motion has begun to slow down it is stopped, and begins anew from there (kinetic damping, Cundall 1976).
  void step(double h);

  NodeVectors& positions() { return now_; }
  const NodeVectors& positions() const { return now_; }
  /// Kinetic energy after the last step, N mm.
  double kineticEnergy() const { return kinetic_; }

 private:
  const System& system_;
  std::vector<Spring> springs_;
  std::vector<double> inverseMass_;   // 0 for driven nodes
  NodeVectors force_;                 // that never changes
  NodeVectors now_, before_, velocity_;
  double kinetic_ = 0;
};

}  // namespace pectora
