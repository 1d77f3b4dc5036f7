#include "plugins/segmenter/thorax/sternum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pectora::thorax {
namespace {

double medianOf(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(v.size() / 2), v.end());
  return v[v.size() / 2];
}

/// The y of the front (least y) of a contour where it crosses the column x.
double frontAt(const Loop& contour, double x) {
  double front = 1e300;
  for (std::size_t n = 0; n < contour.size(); ++n) {
    const Point2 a = contour[n], b = contour[(n + 1) % contour.size()];
    if ((a.x > x) == (b.x > x)) continue;
    front = std::min(front, a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x));
  }
  return front;
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

}  // namespace

Sternum measureSternum(const std::vector<SternumSlice>& slices, double sliceSpacing) {
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

  // Manubriosternal joint: the sharpest forward bend of the axis.
  const std::size_t arm = std::max<std::size_t>(1, std::size_t(25 / sliceSpacing));
  std::size_t joint = xiphoid / 3;
  double sharpest = 2 * std::numbers::pi / 180;
  for (std::size_t n = xiphoid / 5; n <= xiphoid * 45 / 100; ++n) {
    const std::size_t top = n > arm ? n - arm : 0, bottom = std::min(n + arm, xiphoid);
    if (n - top < 2 || bottom - n < 2) continue;
    const double bend = std::atan(slopeOf(sternum.axis, top, n)) - std::atan(slopeOf(sternum.axis, n, bottom));
    if (bend > sharpest) sharpest = bend, joint = n;
  }
  sternum.manubriosternalJoint = sternum.axis[joint];

  // Deepest point of the front surface of the body's caudal half (a normal sternum comes forward from top to bottom, and its
  // deepest point is then the middle), tilt, torsion.
  std::size_t deepest = (joint + xiphoid) / 2;
  double deepestY = -1e300;
  for (std::size_t n = deepest; n <= xiphoid; ++n) {
    const double y = frontAt(slices[n].contour, sternum.axis[n].x);
    if (y < 1e299 && y > deepestY) deepestY = y, deepest = n;
  }
  sternum.deepest = {sternum.axis[deepest].x, deepestY, sternum.axis[deepest].z};
  constexpr double kDegrees = 180 / std::numbers::pi;
  if (xiphoid > joint) sternum.tiltDeg = std::atan(slopeOf(sternum.axis, joint, xiphoid)) * kDegrees;
  const std::size_t reach = std::max<std::size_t>(1, std::size_t(15 / sliceSpacing));
  double sum = 0, weight = 0;
  for (std::size_t n = std::max(joint, deepest > reach ? deepest - reach : 0); n <= std::min(xiphoid, deepest + reach); ++n) {
    if (!slices[n].isSeen || slices[n].shape.elongation() < 1.3) continue;
    sum += slices[n].shape.angle * kDegrees * slices[n].shape.area;
    weight += slices[n].shape.area;
  }
  sternum.torsionDeg = weight > 0 ? sum / weight : 0;

  // Notches: from the manubrium's part for rib 1, the body's for ribs 3 to 7.
  constexpr double kBodyPart[7] = {0, 0, 0.27, 0.51, 0.71, 0.85, 0.95};
  for (int rib = 1; rib <= 7; ++rib) {
    const double place = rib == 1 ? 0.37 * double(joint) : double(joint) + kBodyPart[rib - 1] * double(xiphoid - joint);
    const std::size_t n = std::min(count - 1, std::size_t(std::lround(place)));
    const auto [right, left] = std::minmax_element(slices[n].contour.begin(), slices[n].contour.end(),
                                                   [](Point2 a, Point2 b) { return a.x < b.x; });
    sternum.notches.push_back({Side::right, rib, {right->x, right->y, sternum.axis[n].z}});
    sternum.notches.push_back({Side::left, rib, {left->x, left->y, sternum.axis[n].z}});
  }
  return sternum;
}

}  // namespace pectora::thorax
