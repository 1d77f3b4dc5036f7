// Closed iso-contours of a plane at subpixel precision (marching squares), and the shape of a contour.
#pragma once

#include "plugins/segmenter/thorax/field.h"

#include <array>
#include <vector>

namespace pectora::thorax {

/// A point in a plane. The unit is that of the caller: pixels from isoContours, mm elsewhere.
struct Point2 {
  double x = 0, y = 0;
};
using Loop = std::vector<Point2>;

/// All closed contours at `level`, in pixel coordinates (pixel centres are whole numbers). The plane counts as lying
/// in an infinite field far below `level`, so every contour closes. What is above the level lies to the right of the
/// direction of travel with y down: outer contours have positive area, holes negative. At a saddle the mean of
/// the four corners decides (Nielson and Hamann 1991).
std::vector<Loop> isoContours(const Plane& plane, float level);

/// Area, centroid and Hu's seven moment invariants of the region within a closed polygon.
struct Shape {
  double area = 0;               ///< signed: positive for outer contours of isoContours
  Point2 centroid;
  double spreadMajor = 0;        ///< standard deviation along the longer principal axis
  double spreadMinor = 0;        ///< and across it
  double angle = 0;              ///< of the longer principal axis against x, radians, in (-pi/2, pi/2]
  std::array<double, 7> hu{};    ///< M. K. Hu 1962, of the normalised central moments
  /// Longer over shorter axis, at least 1.
  double elongation() const { return spreadMinor > 0 ? spreadMajor / spreadMinor : 1e9; }
};

/// Exact moments by Green's theorem, m_pq = (1/(p+1)) closed integral of x^(p+1) y^q dy, edge by edge.
Shape shapeOf(const Loop& loop);

/// Root mean square over the points of `a` and of `b` of the distance to the nearest point of the other contour.
double rmsDistance(const Loop& a, const Loop& b);

/// The least and greatest y of a contour (its front and back) where it crosses the column x; front > back if it does not.
struct Column {
  double front = 1e300, back = -1e300;
};
Column columnAt(const Loop& loop, double x);

/// The least and greatest x of a contour: the patient's right and left.
struct Sides {
  double right, left;
};
Sides sidesOf(const Loop& loop);

/// Whether a point lies within a closed polygon (even-odd rule).
bool isInside(const Loop& loop, Point2 p);

}  // namespace pectora::thorax
