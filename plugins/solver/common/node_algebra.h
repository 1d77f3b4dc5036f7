// Sums over the free nodes. They run over fixed pieces and are added in the order of the pieces: the bits do not depend on
// the number of threads.
#pragma once

#include "kernel/physics/system.h"

namespace pectora {

/// sum a_i . b_i over nodes [0, count), in double precision. A and B are NodeVectors or SingleVectors, but for a double B beside a
/// single A.
template <class A, class B>
double dot(const A& a, const B& b, std::size_t count);
/// The same of every v and one b, which is read once; right to about 1e-7 of the products' sizes.
std::vector<double> dots(const std::vector<const SingleVectors*>& vs, const SingleVectors& b, std::size_t count);

/// to_i = x_i + s v_i over nodes [0, count). All are NodeVectors, or all SingleVectors, or v alone is. `to` may be x or v.
template <class X, class V, class To>
void setSum(const X& x, double s, const V& v, To& to, std::size_t count);
/// to_i = sum of factor * v_i over nodes [0, count), written once. `to` may be the first v.
struct Scaled {
  double factor;
  const SingleVectors* v;
};
void setSum(const std::vector<Scaled>& terms, SingleVectors& to, std::size_t count);
/// to_i = from_i over nodes [0, count).
void copy(const NodeVectors& from, SingleVectors& to, std::size_t count);

/// The length of the longest vector of nodes [0, count).
template <class Vectors>
double longest(const Vectors& v, std::size_t count);

/// The largest force on a free node, and where. Infinite if one is not finite.
struct Residual {
  double force = 0;
  std::size_t node = 0;
};
Residual largestResidual(const System& system, const NodeVectors& gradient);

/// A force, N, that moves not even the softest point by more than about 1e-9 mm. Beneath it a system is at rest even where no
/// spring bears a force to compare with, as after the bar went back to where it was.
double negligibleForce(const System& system);

}  // namespace pectora
