#include "plugins/solver/common/node_algebra.h"

#include "kernel/physics/rows.h"
#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr std::size_t kPiece = 4096;   // nodes; a few vectors of them fit the nearest caches

// Sums side by side, so that additions do not wait for each other; always as many, so that their bits are the same for every instruction set.
template <class A, class B>
PECTORA_INLINE double dotOf(const A* a, const B* b, std::size_t count) {
  constexpr std::size_t kLanes = 16;
  double sums[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += double(a[i + lane]) * double(b[i + lane]);
  for (; i < count; ++i) sums[0] += double(a[i]) * double(b[i]);
  double total = 0;
  for (const double sum : sums) total += sum;
  return total;
}
PECTORA_WIDE double dot(const double* a, const double* b, std::size_t count) { return dotOf(a, b, count); }
PECTORA_WIDE double dot(const double* a, const float* b, std::size_t count) { return dotOf(a, b, count); }
PECTORA_WIDE double dot(const float* a, const float* b, std::size_t count) { return dotOf(a, b, count); }

// In single precision over short pieces, and those in double.
PECTORA_WIDE double roughDot(const float* a, const float* b, std::size_t count) {
  constexpr std::size_t kLanes = 64, kShort = 8 * kLanes;
  double total = 0;
  for (std::size_t begin = 0; begin < count; begin += kShort) {
    float sums[kLanes] = {};
    const std::size_t end = begin + kShort < count ? begin + kShort : count;
    std::size_t i = begin;
    for (; i + kLanes <= end; i += kLanes)
      for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += a[i + lane] * b[i + lane];
    for (; i < end; ++i) sums[0] += a[i] * b[i];
    for (std::size_t half = kLanes / 2; half > 0; half /= 2)
      for (std::size_t lane = 0; lane < half; ++lane) sums[lane] += sums[lane + half];
    total += double(sums[0]);
  }
  return total;
}

// to = x + s v.
template <class X, class V, class To>
PECTORA_INLINE void addOf(const X* x, X s, const V* v, To* to, std::size_t count) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) to[i] = To(x[i] + s * X(v[i]));
}
PECTORA_WIDE void add(const double* x, double s, const double* v, double* to, std::size_t count) { addOf(x, s, v, to, count); }
PECTORA_WIDE void add(const double* x, double s, const float* v, double* to, std::size_t count) { addOf(x, s, v, to, count); }
PECTORA_WIDE void add(const double* x, double s, const double* v, float* to, std::size_t count) { addOf(x, s, v, to, count); }
PECTORA_WIDE void add(const float* x, float s, const float* v, float* to, std::size_t count) { addOf(x, s, v, to, count); }

PECTORA_WIDE void scale(float s, const float* v, float* to, std::size_t count) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) to[i] = s * v[i];
}

}  // namespace

template <class A, class B>
double dot(const A& a, const B& b, std::size_t count) {
  std::vector<double> sums(piecesOf(count, kPiece));
  forEachPiece(count, kPiece, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    const std::size_t n = end - begin;
    sums[piece] = dot(&a.x[begin], &b.x[begin], n) + dot(&a.y[begin], &b.y[begin], n) + dot(&a.z[begin], &b.z[begin], n);
  });
  double total = 0;
  for (const double s : sums) total += s;
  return total;
}
template double dot(const NodeVectors&, const NodeVectors&, std::size_t);
template double dot(const NodeVectors&, const SingleVectors&, std::size_t);
template double dot(const SingleVectors&, const SingleVectors&, std::size_t);

std::vector<double> dots(const std::vector<const SingleVectors*>& vs, const SingleVectors& b, std::size_t count) {
  std::vector<double> sums(piecesOf(count, kPiece) * vs.size()), totals(vs.size());
  forEachPiece(count, kPiece, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    const std::size_t n = end - begin;
    double* sum = sums.data() + piece * vs.size();
    for (const SingleVectors* v : vs) *sum++ = roughDot(&b.x[begin], &v->x[begin], n) + roughDot(&b.y[begin], &v->y[begin], n) + roughDot(&b.z[begin], &v->z[begin], n);
  });
  for (std::size_t i = 0; i < sums.size(); ++i) totals[i % vs.size()] += sums[i];
  return totals;
}

template <class X, class V, class To>
void setSum(const X& x, double s, const V& v, To& to, std::size_t count) {
  using Number = typename decltype(x.x)::value_type;
  forEachPiece(count, kPiece, [&](std::size_t, std::size_t begin, std::size_t end) {
    add(&x.x[begin], Number(s), &v.x[begin], &to.x[begin], end - begin);
    add(&x.y[begin], Number(s), &v.y[begin], &to.y[begin], end - begin);
    add(&x.z[begin], Number(s), &v.z[begin], &to.z[begin], end - begin);
  });
}
template void setSum(const NodeVectors&, double, const NodeVectors&, NodeVectors&, std::size_t);
template void setSum(const NodeVectors&, double, const SingleVectors&, NodeVectors&, std::size_t);
template void setSum(const SingleVectors&, double, const SingleVectors&, SingleVectors&, std::size_t);
template void setSum(const NodeVectors&, double, const NodeVectors&, SingleVectors&, std::size_t);

void setSum(const std::vector<Scaled>& terms, SingleVectors& to, std::size_t count) {
  forEachPiece(count, kPiece, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (auto axis : {&SingleVectors::x, &SingleVectors::y, &SingleVectors::z}) {
      float* sum = &(to.*axis)[begin];
      scale(float(terms[0].factor), &(terms[0].v->*axis)[begin], sum, end - begin);
      for (std::size_t k = 1; k < terms.size(); ++k) add(sum, float(terms[k].factor), &(terms[k].v->*axis)[begin], sum, end - begin);
    }
  });
}

void copy(const NodeVectors& from, SingleVectors& to, std::size_t count) {
  forEachPiece(count, kPiece, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) to.x[i] = float(from.x[i]);
    for (std::size_t i = begin; i < end; ++i) to.y[i] = float(from.y[i]);
    for (std::size_t i = begin; i < end; ++i) to.z[i] = float(from.z[i]);
  });
}

template <class Vectors>
double longest(const Vectors& v, std::size_t count) {
  using Number = typename decltype(v.x)::value_type;
  std::vector<Number> squared(piecesOf(count, kPiece));
  forEachPiece(count, kPiece, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    Number largest = 0;
    for (std::size_t i = begin; i < end; ++i) largest = std::max(largest, v.x[i] * v.x[i] + v.y[i] * v.y[i] + v.z[i] * v.z[i]);
    squared[piece] = largest;
  });
  return squared.empty() ? 0 : std::sqrt(double(*std::max_element(squared.begin(), squared.end())));
}
template double longest(const NodeVectors&, std::size_t);
template double longest(const SingleVectors&, std::size_t);

double negligibleForce(const System& system) {
  const std::vector<double> bound = system.stiffnessBound();
  return bound.empty() ? 0 : 1e-9 * *std::min_element(bound.begin(), bound.begin() + std::ptrdiff_t(system.freeNodes));
}

Residual largestResidual(const System& system, const NodeVectors& gradient) {
  const std::size_t count = system.freeNodes;
  std::vector<Residual> found(piecesOf(count, kPiece));
  forEachPiece(count, kPiece, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    double squared = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const double here = dot(gradient[i], gradient[i]);
      if (!std::isfinite(here)) {
        found[piece] = {INFINITY, i};
        return;
      }
      if (here > squared) squared = here, found[piece].node = i;
    }
    found[piece].force = std::sqrt(squared);
  });
  const auto largest = std::max_element(found.begin(), found.end(), [](const Residual& a, const Residual& b) { return a.force < b.force; });
  return largest == found.end() ? Residual{} : *largest;
}

}  // namespace pectora
