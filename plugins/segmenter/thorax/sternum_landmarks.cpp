#include "plugins/segmenter/thorax/sternum.h"

#include "kernel/value/levels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pectora::thorax {
namespace {

constexpr double kDeepestPart = 0.84;   // of the width, in which the deepest point is sought

double medianOf(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(v.size() / 2), v.end());
  return v[v.size() / 2];
}

/// Slope dy/dz of the axis by linear regression over entries [a, b].
double slopeOf(const std::vector<Vec3>& axis, std::size_t a, std::size_t b) {
  const double n = double(b - a + 1);
  double y = 0, z = 0, zz = 0, yz = 0;
  for (std::size_t i = a; i <= b; ++i) y += axis[i].y / n, z += axis[i].z / n;
  for (std::size_t i = a; i <= b; ++i)
    zz += (axis[i].z - z) * (axis[i].z - z), yz += (axis[i].z - z) * (axis[i].y - y);
  return zz > 0 ? yz / zz : 0;
}

/// Residual (sum of squares) of the best line through values [a, b] that is straight but for a bend at `bend` (a: none).
double bentResidual(const std::vector<double>& values, std::size_t a, std::size_t b, std::size_t bend) {
  // Least squares in the basis 1, n - bend, max(0, n - bend).
  double m[3][4] = {};
  const int terms = bend > a ? 3 : 2;
  const auto basis = [&](std::size_t n, double (&f)[3]) {
    const double d = double(n) - double(bend);
    f[0] = 1, f[1] = d, f[2] = std::max(0.0, d);
  };
  double f[3];
  for (std::size_t n = a; n <= b; ++n) {
    basis(n, f);
    for (int i = 0; i < terms; ++i) {
      for (int j = 0; j < terms; ++j) m[i][j] += f[i] * f[j];
      m[i][3] += f[i] * values[n];
    }
  }
  for (int i = 0; i < terms; ++i)
    for (int r = 0; r < terms; ++r) {
      if (r == i || m[i][i] == 0) continue;
      const double factor = m[r][i] / m[i][i];
      for (int j = 0; j < 4; ++j) m[r][j] -= factor * m[i][j];
    }
  double residual = 0;
  for (std::size_t n = a; n <= b; ++n) {
    basis(n, f);
    double off = values[n];
    for (int i = 0; i < terms; ++i) off -= m[i][i] != 0 ? f[i] * m[i][3] / m[i][i] : 0;
    residual += off * off;
  }
  return residual;
}

}  // namespace

Sternum measureSternum(const std::vector<SternumSlice>& slices, double sliceSpacing, double turnDeg) {
  Sternum sternum;
  if (slices.size() < 2) return sternum;
  const std::size_t count = slices.size();
  for (const SternumSlice& s : slices) {
    const double z = s.slice * sliceSpacing;
    sternum.axis.push_back({s.shape.centroid.x, s.shape.centroid.y, z});
    std::vector<Vec3> contour;
    for (Point2 p : s.contour) contour.push_back({p.x, p.y, z});
    sternum.contours.push_back(std::move(contour));
  }
  sternum.jugularNotch = sternum.axis.front();

  // Xiphisternal joint: below it the contours are small.
  std::vector<double> areas;
  for (std::size_t n = count * 45 / 100; n <= std::min(count - 1, count * 8 / 10); ++n) areas.push_back(slices[n].shape.area);
  const double usual = medianOf(areas);
  std::size_t xiphoid = count - 1;
  while (xiphoid > count / 2 && slices[xiphoid].shape.area < 0.55 * usual) --xiphoid;
  sternum.xiphisternalJoint = sternum.axis[xiphoid];

  // Manubriosternal joint: the bend of width and depth, each against its own straight line.
  std::vector<double> widths, depths;
  for (const SternumSlice& slice : slices) {
    const Sides sides = sidesOf(slice.contour);
    widths.push_back(sides.left - sides.right), depths.push_back(slice.shape.centroid.y);
  }
  std::size_t joint = xiphoid / 3;
  const std::size_t from = xiphoid / 10, to = xiphoid * 3 / 4;
  double least = 1e300;
  for (std::size_t n = xiphoid / 5; n <= xiphoid / 2 && to > from + 6; ++n) {
    double misfit = 0;
    for (const std::vector<double>* values : {&widths, &depths})
      misfit += bentResidual(*values, from, to, n) / std::max(1e-9, bentResidual(*values, from, to, from));
    if (misfit < least) least = misfit, joint = n;
  }
  sternum.manubriosternalJoint = sternum.axis[joint];

  // Deepest point of the front surface of the body's caudal half (a normal sternum comes forward from top to bottom, and its
  // deepest point is then the middle), away from the rounded edges; tilt, torsion.
  std::size_t deepest = (joint + xiphoid) / 2;
  sternum.deepest = {sternum.axis[deepest].x, -1e300, sternum.axis[deepest].z};
  for (std::size_t n = deepest; n <= xiphoid; ++n) {
    const Sides sides = sidesOf(slices[n].contour);
    const double middle = 0.5 * (sides.right + sides.left), half = kDeepestPart * 0.5 * (sides.left - sides.right);
    for (int c = -8; c <= 8; ++c) {
      const double x = middle + half * c / 8, y = columnAt(slices[n].contour, x).front;
      if (y < 1e299 && y > sternum.deepest.y) sternum.deepest = {x, y, sternum.axis[n].z}, deepest = n;
    }
  }
  constexpr double kDegrees = 180 / std::numbers::pi;
  if (xiphoid > joint) sternum.tiltDeg = std::atan(slopeOf(sternum.axis, joint, xiphoid)) * kDegrees;
  const std::size_t reach = std::max<std::size_t>(1, std::size_t(15 / sliceSpacing));
  double levels = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t k = std::max(joint, deepest > reach ? deepest - reach : 0); k <= std::min(xiphoid, deepest + reach); ++k) {
    if (!slices[k].isSeen) continue;
    const double away = double(k) - double(deepest), angle = sectionTorsion(sternum.contours[k]) - turnDeg;
    levels += 1, x += away, y += angle, xx += away * away, xy += away * angle;
  }
  // The regression line's value at the deepest level.
  const double square = levels * xx - x * x;
  if (levels > 0) sternum.torsionDeg = square > 0 ? (y * xx - x * xy) / square : y / levels;

  // Notches: from the manubrium's part for rib 1, the body's for ribs 3 to 7.
  constexpr double kBodyPart[7] = {0, 0, 0.27, 0.51, 0.71, 0.85, 0.95};
  for (int rib = 1; rib <= 7; ++rib) {
    const double place = rib == 1 ? 0.37 * double(joint) : double(joint) + kBodyPart[rib - 1] * double(xiphoid - joint);
    const std::size_t n = std::min(count - 1, std::size_t(std::lround(place)));
    const Sides sides = sidesOf(slices[n].contour);
    const double slope = std::tan(sectionTorsion(sternum.contours[n]) / kDegrees);
    for (Side side : {Side::right, Side::left}) {
      const double edge = side == Side::right ? sides.right : sides.left;
      sternum.notches.push_back({side, rib, {edge, slices[n].shape.centroid.y + slope * (edge - slices[n].shape.centroid.x), sternum.axis[n].z}});
    }
  }
  return sternum;
}

}  // namespace pectora::thorax
