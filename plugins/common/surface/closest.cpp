#include "plugins/common/surface/closest.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

// The closest point of a segment, and 0 or 1 for its ends, -1 between.
std::pair<Vec3, int> closestOnSegment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 d = b - a;
  const double squared = dot(d, d);
  const double t = squared > 0 ? dot(p - a, d) / squared : 0;
  if (t <= 0) return {a, 0};
  if (t >= 1) return {b, 1};
  return {a + d * t, -1};
}

ClosestPoint closestOnEdges(Vec3 p, const std::array<Vec3, 3>& corner) {
  ClosestPoint best;
  double least = INFINITY;
  for (int e = 0; e < 3; ++e) {
    const auto [point, end] = closestOnSegment(p, corner[e], corner[(e + 1) % 3]);
    const double d = dot(p - point, p - point);
    if (d >= least) continue;
    least = d;
    best = {point, end < 0 ? Feature(3 + e) : Feature((e + end) % 3)};
  }
  return best;
}

}  // namespace

ClosestPoint closestOnTriangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {a, Feature::cornerA};
  const Vec3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {b, Feature::cornerB};
  const Vec3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {c, Feature::cornerC};

  // Barycentric regions of the three edges and the inside.
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  const double sum = va + vb + vc;
  if (!(sum > 0)) return closestOnEdges(p, {a, b, c});
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + ab * (d1 / (d1 - d3)), Feature::edgeAB};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + ac * (d2 / (d2 - d6)), Feature::edgeCA};
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return {b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), Feature::edgeBC};
  return {a + ab * (vb / sum) + ac * (vc / sum), Feature::face};
}

}  // namespace pectora
