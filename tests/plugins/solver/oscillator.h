// One mass on a spring to a driven node at the origin, moving along x.
#pragma once

#include "kernel/physics/springs.h"

#include <cmath>

namespace pectora {

struct Oscillator {
  static constexpr double kRest = 10;   // mm
  double mass = 0.002, stiffness = 0.8; // kg, N/mm
  System system;

  Oscillator() {
    system.rows = system.columns = 1;
    system.freeNodes = 1;
    system.rest = NodeVectors(2);
    system.rest.set(0, {kRest, 0, 0});
    system.mass = {mass};
    system.terms.push_back(makeSpringTerm("spring", system, {{0, 1, stiffness}}));
  }
  /// Angular frequency, 1/s.
  double omega() const { return std::sqrt(1000 * stiffness / mass); }
  NodeVectors stretched(double amplitude) const {
    NodeVectors x = system.rest;
    x.x[0] += amplitude;
    return x;
  }
};

}  // namespace pectora
