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
template <class A, class B>
double dot(const A* a, const B* b, std::size_t count) {
  double sums[4] = {};
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4)
    for (int lane = 0; lane < 4; ++lane) sums[lane] += double(a[i + lane]) * double(b[i + lane]);
  for (; i < count; ++i) sums[0] += double(a[i]) * double(b[i]);
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

template <class X, class Y>
void axpy(double s, const X* x, Y* y, std::size_t count) {
  const Y factor = Y(s);
  for (std::size_t i = 0; i < count; ++i) y[i] += factor * Y(x[i]);
}

}  // namespace

template <class A, class B>
double dot(const A& a, const B& b, std::size_t count) {
  std::vector<double> sums((count + kPiece - 1) / kPiece);
  forEachPiece(count, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    const std::size_t n = end - begin;
    sums[piece] = dot(&a.x[begin], &b.x[begin], n) + dot(&a.y[begin], &b.y[begin], n) + dot(&a.z[begin], &b.z[begin], n);
  });
  double total = 0;
  for (const double s : sums) total += s;
  return total;
}

template <class X, class Y>
void axpy(double s, const X& x, Y& y, std::size_t count) {
  forEachPiece(count, [&](std::size_t, std::size_t begin, std::size_t end) {
    axpy(s, &x.x[begin], &y.x[begin], end - begin);
    axpy(s, &x.y[begin], &y.y[begin], end - begin);
    axpy(s, &x.z[begin], &y.z[begin], end - begin);
  });
}

template <class Vectors>
void scaleAndAdd(const Vectors& x, double s, Vectors& y, std::size_t count) {
  using Number = typename decltype(x.x)::value_type;
  const Number factor = Number(s);
  forEachPiece(count, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) y.x[i] = x.x[i] + factor * y.x[i];
    for (std::size_t i = begin; i < end; ++i) y.y[i] = x.y[i] + factor * y.y[i];
    for (std::size_t i = begin; i < end; ++i) y.z[i] = x.z[i] + factor * y.z[i];
  });
}

template double dot(const NodeVectors&, const NodeVectors&, std::size_t);
template double dot(const NodeVectors&, const SingleVectors&, std::size_t);
template double dot(const SingleVectors&, const SingleVectors&, std::size_t);
template void axpy(double, const NodeVectors&, NodeVectors&, std::size_t);
template void axpy(double, const SingleVectors&, NodeVectors&, std::size_t);
template void axpy(double, const SingleVectors&, SingleVectors&, std::size_t);

template void scaleAndAdd(const NodeVectors&, double, NodeVectors&, std::size_t);
template void scaleAndAdd(const SingleVectors&, double, SingleVectors&, std::size_t);

template <class Vectors>
double longest(const Vectors& v, std::size_t count) {
  typename decltype(v.x)::value_type squared = 0;
  for (std::size_t i = 0; i < count; ++i) squared = std::max(squared, v.x[i] * v.x[i] + v.y[i] * v.y[i] + v.z[i] * v.z[i]);
  return std::sqrt(double(squared));
}
template double longest(const NodeVectors&, std::size_t);
template double longest(const SingleVectors&, std::size_t);

double negligibleForce(const System& system) {
  const std::vector<double> bound = system.stiffnessBound();
  return bound.empty() ? 0 : 1e-9 * *std::min_element(bound.begin(), bound.begin() + std::ptrdiff_t(system.freeNodes));
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
