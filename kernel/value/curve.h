// Clamped B-spline curves (ribs and cartilages) and polylines.
#pragma once

#include "kernel/value/vec3.h"

#include <span>
#include <vector>

namespace pectora {

/// A clamped B-spline: the curve starts at the first control point and ends at the last.
/// De Boor's recurrence; knots.size() == controls.size() + degree + 1, parameter from 0 to 1; degree 1 to 7.
struct Curve {
  int degree = 3;
  std::vector<double> knots;
  std::vector<Vec3> controls;  ///< LPS, mm

  Vec3 at(double u) const;
  Vec3 derivative(double u) const;           ///< dC/du, mm
  double length() const;                     ///< arc length, mm, by Gauss quadrature on each knot span
  std::vector<Vec3> sample(int count) const; ///< `count` >= 2 points, equally spaced in u
  /// Parameter of the point on the curve that is closest to p, to about 1e-6 in u.
  double closest(Vec3 p) const;
};

/// Knots of a clamped spline with `controls` control points whose inner knots are equally spaced.
std::vector<double> clampedKnots(int controls, int degree);
/// Values of the basis functions at u: `first` is the first control point that matters, degree+1 weights follow.
struct BasisWeights {
  int first = 0;
  std::vector<double> weights;
};
BasisWeights basis(std::span<const double> knots, int degree, double u);

/// Length of a polyline, mm.
double polylineLength(std::span<const Vec3> line);
/// `count` >= 2 points at equal arc length along a polyline.
std::vector<Vec3> resamplePolyline(std::span<const Vec3> line, int count);

/// Whether p lies in a closed contour of one axial level; z is not looked at.
bool isInContour(std::span<const Vec3> contour, Vec3 p);

}  // namespace pectora
