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

/// The cubic Hermite curve from `a`, leaving along `tangentA`, to `b`, arriving along `tangentB` (unit vectors), as a clamped
/// B-spline with four control points; the handles are `handleA` and `handleB` times the distance a-b. C'(0) = 3 (P1 - P0).
Curve hermiteCurve(Vec3 a, Vec3 tangentA, Vec3 b, Vec3 tangentB, double handleA, double handleB);

}  // namespace pectora
