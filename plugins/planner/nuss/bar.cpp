#include "plugins/planner/nuss/bar.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pectora {
namespace {

constexpr double kRibRadius = 6;   // from a rib's centre line to its outer side, mm

// The back of the moved sternum at the bar: its most posterior contour point within 15 mm of the bar's plane.
double backOfSternum(const Sternum& sternum, const RigidMotion& motion, Vec3 lifted, Vec3 up) {
  double back = -INFINITY;
  for (const auto& contour : sternum.contours)
    for (const Vec3& p : contour)
      if (const Vec3 moved = motion(p); std::abs(dot(moved - lifted, up)) < 15) back = std::max(back, moved.y);
  return std::isfinite(back) ? back : lifted.y + 10;
}

}  // namespace

Bar shapeBar(const RibCage& cage, Vec3 point, double lift, const RigidMotion& motion, double tiltDeg, const BarSettings& settings) {
  Bar bar{.point = point, .lift = lift, .width = settings.width, .height = settings.height};
  const double tilt = tiltDeg * std::numbers::pi / 180;
  bar.up = {-std::sin(tilt), 0, std::cos(tilt)};
  const Sternum& sternum = cage.anatomy->sternum;
  const Vec3 lifted = motion(point);
  bar.rightSpace = intercostalSpace(sternum, Side::right, point, bar.up);
  bar.leftSpace = intercostalSpace(sternum, Side::left, point, bar.up);
  const double middleY = backOfSternum(sternum, motion, lifted, bar.up) + settings.height / 2;

  // Ribs where they pass the bar's plane, right and left: the crest beside the pit and the widest point.
  struct Flank {
    Vec3 crest, side;
    bool found = false;
  };
  std::vector<Vec3> near;
  for (const RibCurve& rib : cage.ribs)
    for (const Vec3& p : rib.curve.sample(200))
      if (std::abs(dot(p - lifted, bar.up)) <= 12) near.push_back(p);
  const auto flank = [&](double sign) {
    Flank f;
    f.side = {point.x, 0, 0};
    for (const Vec3& p : near) {
      if (sign * (p.x - point.x) < 30) continue;
      if (!f.found || p.y < f.crest.y) f.crest = p;
      if (!f.found || sign * p.x > sign * f.side.x) f.side = p;
      f.found = true;
    }
    return f;
  };
  const Flank right = flank(-1), left = flank(1);

  // Control polygon of a clamped cubic: end, hinge, flat middle, hinge, end.
  std::vector<Vec3>& polygon = bar.centerline;
  const double half = settings.flat / 2 * bar.up.z;
  if (right.found) {
    polygon.push_back(right.side + Vec3{-kRibRadius, 0, 0});
    polygon.push_back({right.side.x - kRibRadius, 0.5 * (right.side.y + right.crest.y), 0});
    polygon.push_back(right.crest + Vec3{0, -kRibRadius, 0});
  }
  for (const double part : {-2, -1, 1, 2}) polygon.push_back({point.x + part * half, middleY, 0});
  if (left.found) {
    polygon.push_back(left.crest + Vec3{0, -kRibRadius, 0});
    polygon.push_back({left.side.x + kRibRadius, 0.5 * (left.side.y + left.crest.y), 0});
    polygon.push_back(left.side + Vec3{kRibRadius, 0, 0});
  }
  for (Vec3& p : polygon) p.z = lifted.z + (p.x - lifted.x) * std::tan(tilt);
  bar.centerline = Curve{3, clampedKnots(int(polygon.size()), 3), polygon}.sample(81);
  return bar;
}

int intercostalSpace(const Sternum& sternum, Side side, Vec3 point, Vec3 up) {
  int space = 0;
  for (const Notch& notch : sternum.notches)
    if (notch.side == side && dot(notch.position - point, up) >= 0) space = std::max(space, notch.rib);
  return space;
}

}  // namespace pectora
