#include "plugins/solver/common/node_algebra.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr std::size_t kPiece = 8192;

template <class F>
void forEachPiece(std::size_t count, F&& f) {
  parallelFor((count + kPiece - 1) / kPiece, [&](std::size_t piece) {
    f(piece, piece * kPiece, std::min(count, (piece + 1) * kPiece));
  });
}

// Four sums side by side, so that additions do not wait for each other.
double dot(const double* a, const double* b, std::size_t count) {
  double sums[4] = {};
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4)
    for (int lane = 0; lane < 4; ++lane) sums[lane] += a[i + lane] * b[i + lane];
  for (; i < count; ++i) sums[0] += a[i] * b[i];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

}  // namespace

double dot(const NodeVectors& a, const NodeVectors& b, std::size_t count) {
  std::vector<double> sums((count + kPiece - 1) / kPiece);
  forEachPiece(count, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    const std::size_t n = end - begin;
    sums[piece] = dot(&a.x[begin], &b.x[begin], n) + dot(&a.y[begin], &b.y[begin], n) + dot(&a.z[begin], &b.z[begin], n);
  });
  double total = 0;
  for (const double s : sums) total += s;
  return total;
}

void axpy(double s, const NodeVectors& x, NodeVectors& y, std::size_t count) {
  forEachPiece(count, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) y.x[i] += s * x.x[i];
    for (std::size_t i = begin; i < end; ++i) y.y[i] += s * x.y[i];
    for (std::size_t i = begin; i < end; ++i) y.z[i] += s * x.z[i];
  });
}

void scaleAndAdd(const NodeVectors& x, double s, NodeVectors& y, std::size_t count) {
  forEachPiece(count, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) y.x[i] = x.x[i] + s * y.x[i];
    for (std::size_t i = begin; i < end; ++i) y.y[i] = x.y[i] + s * y.y[i];
    for (std::size_t i = begin; i < end; ++i) y.z[i] = x.z[i] + s * y.z[i];
  });
}

double negligibleForce(const System& system) {
  const std::vector<double> bound = system.stiffnessBound();
  return bound.empty() ? 0 : 1e-9 * *std::max_element(bound.begin(), bound.end());
}

Residual largestResidual(const System& system, const NodeVectors& gradient) {
  Residual r;
  double squared = 0;
  for (std::size_t i = 0; i < system.freeNodes; ++i) {
    const double here = dot(gradient[i], gradient[i]);
    if (!std::isfinite(here)) return {INFINITY, i};
    if (here > squared) squared = here, r.node = i;
  }
  r.force = std::sqrt(squared);
  return r;
}

}  // namespace pectora
