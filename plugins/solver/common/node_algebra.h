// Sums over the free nodes. They run over fixed pieces and are added in the order of the pieces: the bits do not depend on
// the number of threads.
#pragma once

#include "kernel/physics/system.h"

namespace pectora {

/// sum a_i . b_i over nodes [0, count).
double dot(const NodeVectors& a, const NodeVectors& b, std::size_t count);
/// y_i += s x_i over nodes [0, count).
void axpy(double s, const NodeVectors& x, NodeVectors& y, std::size_t count);
/// y_i = x_i + s y_i over nodes [0, count).
void scaleAndAdd(const NodeVectors& x, double s, NodeVectors& y, std::size_t count);

/// The largest force on a free node, and where. Infinite if one is not finite.
struct Residual {
  double force = 0;
  std::size_t node = 0;
};
Residual largestResidual(const System& system, const NodeVectors& gradient);

/// A force, N, that moves nothing by more than about 1e-9 mm. Beneath it a system is at rest even where no spring bears a
/// force to compare with, as after the bar went back to where it was.
double negligibleForce(const System& system);

}  // namespace pectora
