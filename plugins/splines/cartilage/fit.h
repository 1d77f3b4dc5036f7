// Least-squares and interpolating B-splines.
#pragma once

#include "kernel/value/curve.h"

#include <span>

namespace pectora {

/// Clamped cubic B-spline in the least-squares sense through points in order (chord-length parameters, equal knots).
/// The ends are met exactly. `controls` is lowered to the number of points where there are fewer; at least 4 points.
Curve fitCurve(std::span<const Vec3> points, int controls);
/// Root mean square distance from the points to the curve, mm.
double rmsDistance(const Curve& curve, std::span<const Vec3> points);

/// Clamped cubic B-spline with `controls` >= 4 control points that is the cubic Hermite curve from `a`, leaving along
/// `tangentA`, to `b`, arriving along `tangentB` (unit vectors); the handles are `handle` times the distance a-b.
Curve hermiteCurve(Vec3 a, Vec3 tangentA, Vec3 b, Vec3 tangentB, double handle, int controls);

}  // namespace pectora
