// Vectors of chance, and what tests of derivatives compare.
#pragma once

#include "kernel/physics/hessian.h"

#include <random>

namespace pectora {

inline NodeVectors noise(std::size_t nodes, double amplitude, unsigned seed) {
  NodeVectors v(nodes);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-amplitude, amplitude);
  for (std::size_t i = 0; i < nodes; ++i) v.set(i, {jitter(random), jitter(random), jitter(random)});
  return v;
}

inline NodeVectors sum(const NodeVectors& a, double s, const NodeVectors& b) {
  NodeVectors c(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) c.set(i, a[i] + b[i] * s);
  return c;
}

inline double inner(const NodeVectors& a, const NodeVectors& b) {
  double total = 0;
  for (std::size_t i = 0; i < a.size(); ++i) total += dot(a[i], b[i]);
  return total;
}

inline NodeVectors gradientAt(const System& system, const NodeVectors& x) {
  NodeVectors gradient(x.size());
  double largest = 0;
  system.evaluate(x, gradient, largest);
  return gradient;
}

inline NodeVectors product(const Hessian& hessian, const NodeVectors& v) {
  NodeVectors y(v.size());
  hessian.multiply(v, y);
  return y;
}

/// The same, put together from the blocks that the Hessian shows.
inline NodeVectors productOfBlocks(const Hessian& hessian, const NodeVectors& v) {
  std::vector<Symmetric3> diagonal(v.size());
  hessian.addDiagonal(diagonal);
  NodeVectors y(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) y.set(i, diagonal[i] * v[i]);
  hessian.forEachCoupling([&](std::size_t a, std::size_t b, const Matrix3& block) {
    const auto& m = block.m;
    const Vec3 p = v[a], q = v[b];
    y.add(a, {m[0][0] * q.x + m[0][1] * q.y + m[0][2] * q.z, m[1][0] * q.x + m[1][1] * q.y + m[1][2] * q.z,
              m[2][0] * q.x + m[2][1] * q.y + m[2][2] * q.z});
    y.add(b, {m[0][0] * p.x + m[1][0] * p.y + m[2][0] * p.z, m[0][1] * p.x + m[1][1] * p.y + m[2][1] * p.z,
              m[0][2] * p.x + m[1][2] * p.y + m[2][2] * p.z});
  });
  return y;
}

}  // namespace pectora
