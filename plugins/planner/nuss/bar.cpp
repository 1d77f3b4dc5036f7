#include "plugins/planner/nuss/bar.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr double kRibRadius = 6;   // from a rib's centre line to its outer side, mm

// The back of the moved sternum at height z: its most posterior contour point within 15 mm of that level.
double backOfSternum(const Sternum& sternum, const RigidMotion& motion, Vec3 deepest) {
  double back = -INFINITY;
  const double z = motion(deepest).z;
  for (const auto& contour : sternum.contours)
    for (const Vec3& p : contour)
      if (const Vec3 moved = motion(p); std::abs(moved.z - z) < 15) back = std::max(back, moved.y);
  return std::isfinite(back) ? back : motion(deepest).y + 10;
}

}  // namespace

Bar shapeBar(const RibCage& cage, Vec3 deepest, const RigidMotion& motion, const BarSettings& settings) {
  Bar bar{{}, settings.width, settings.height};
  const double z = motion(deepest).z;
  const double middleY = backOfSternum(cage.anatomy->sternum, motion, deepest) + settings.height / 2;

  // Ribs where they pass the bar's level, right and left: the crest beside the pit and the widest point.
  struct Flank {
    Vec3 crest, side;
    bool found = false;
  };
  const auto flank = [&](double sign) {
    Flank f;
    f.side = {deepest.x, 0, z};
    for (const RibCurve& rib : cage.ribs) {
      for (const Vec3& p : rib.curve.sample(200)) {
        if (std::abs(p.z - z) > 12 || sign * (p.x - deepest.x) < 30) continue;
        if (!f.found || p.y < f.crest.y) f.crest = p;
        if (!f.found || sign * p.x > sign * f.side.x) f.side = p;
        f.found = true;
      }
    }
    return f;
  };
  const Flank right = flank(-1), left = flank(1);

  // Control polygon of a clamped cubic: end, hinge, flat middle, hinge, end.
  std::vector<Vec3> polygon;
  const double half = settings.flat / 2;
  if (right.found) {
    polygon.push_back(right.side + Vec3{-kRibRadius, 0, 0});
    polygon.push_back(Vec3{right.side.x - kRibRadius, 0.5 * (right.side.y + right.crest.y), z});
    polygon.push_back(right.crest + Vec3{0, -kRibRadius, 0});
  }
  polygon.push_back({deepest.x - 2 * half, middleY, z});
  polygon.push_back({deepest.x - half, middleY, z});
  polygon.push_back({deepest.x + half, middleY, z});
  polygon.push_back({deepest.x + 2 * half, middleY, z});
  if (left.found) {
    polygon.push_back(left.crest + Vec3{0, -kRibRadius, 0});
    polygon.push_back(Vec3{left.side.x + kRibRadius, 0.5 * (left.side.y + left.crest.y), z});
    polygon.push_back(left.side + Vec3{kRibRadius, 0, 0});
  }
  for (Vec3& p : polygon) p.z = z;
  Curve curve;
  curve.controls = polygon;
  curve.knots = clampedKnots(int(polygon.size()), 3);
  bar.centerline = curve.sample(81);
  return bar;
}

}  // namespace pectora
