#include "skeleton.h"

#include "smooth.h"
#include "kernel/value/curve.h"

namespace pectora::phantom {
namespace {

constexpr double kPieceMm = 3;  // length of the polylines' pieces

/// x = a sin(t), f = b (1 - cos(t)), y = 32 - f cos(alpha), z = z_i - f sin(alpha), until the arc length is L.
std::vector<Vec3> ribLine(int number, double sign, double depthScale) {
  const RibRow& row = ribRow(number);
  const double alpha = radians(row.tiltDeg), a = row.width / 2;
  const double b = row.depth * depthScale / (2 * std::cos(alpha));
  const auto at = [&](double t) {
    const double f = b * (1 - std::cos(t));
    return Vec3{sign * a * std::sin(t), kRibBack - f * std::cos(alpha), row.z - f * std::sin(alpha)};
  };
  // Walk in fine steps and cut the last one where the length is reached.
  std::vector<Vec3> fine{at(std::asin(18 / a))};
  double length = 0;
  for (double t = std::asin(18 / a) + 0.002;; t += 0.002) {
    const Vec3 next = at(t);
    const double piece = distance(fine.back(), next);
    if (length + piece >= row.length) {
      fine.push_back(lerp(fine.back(), next, (row.length - length) / piece));
      break;
    }
    length += piece;
    fine.push_back(next);
  }
  return resamplePolyline(fine, int(row.length / kPieceMm) + 1);
}

std::vector<Vec3> hermite(Vec3 p, Vec3 q, Vec3 tangentP, Vec3 tangentQ) {
  std::vector<Vec3> line;
  for (int i = 0; i <= 60; ++i) {
    const double t = i / 60.0, t2 = t * t, t3 = t2 * t;
    line.push_back(p * (2 * t3 - 3 * t2 + 1) + tangentP * (t3 - 2 * t2 + t) + q * (3 * t2 - 2 * t3) +
                   tangentQ * (t3 - t2));
  }
  return line;
}

/// The Hermite curve from p to q whose length is as near to `length` as handles of 0.4 to 1.5 chords allow.
std::vector<Vec3> curveOfLength(Vec3 p, Vec3 q, Vec3 directionP, Vec3 directionQ, double length) {
  const double chord = distance(p, q);
  double low = 0.4, high = 1.5;
  for (int i = 0; i < 30; ++i) {
    const double handle = (low + high) / 2 * chord;
    const auto line = hermite(p, q, directionP * handle, directionQ * handle);
    (polylineLength(line) < length ? low : high) = (low + high) / 2;
  }
  const double handle = (low + high) / 2 * chord;
  const auto line = hermite(p, q, directionP * handle, directionQ * handle);
  return resamplePolyline(line, std::max(4, int(polylineLength(line) / kPieceMm) + 1));
}

Vec3 endTangent(const std::vector<Vec3>& line) { return normalized(line.back() - line[line.size() - 2]); }

BoneLine cartilage(const Skeleton& skeleton, Side side, int number, const std::vector<Vec3>* upper) {
  const double sign = side == Side::right ? -1 : 1;
  const std::vector<Vec3>& rib = skeleton.ribs[2 * (number - 1) + (side == Side::left)].line;
  BoneLine result{side, number, number <= 7 ? 0 : number - 1, {}};
  if (number <= 7) {
    // To the notch; it arrives from lateral and caudal, steeper for the lower ribs.
    Vec3 notch = skeleton.sternum.at(ribRow(number).notch);
    notch.x = sign * 18;
    const double rise = std::clamp((number - 2) * 0.18, -0.3, 0.8);
    const Vec3 arrival = normalized({-sign, 0.15, rise});
    result.line = curveOfLength(rib.back(), notch, endTangent(rib), arrival, ribRow(number).cartilage);
  } else {
    // To the cartilage above, along which it nestles.
    const std::size_t index = std::size_t(double(upper->size() - 1) * (number == 8 ? 0.55 : 0.6));
    const Vec3 target = (*upper)[index];
    const Vec3 along = normalized((*upper)[index + 1] - (*upper)[index]);
    result.line = curveOfLength(rib.back(), target, endTangent(rib), along, ribRow(number).cartilage);
  }
  return result;
}

}  // namespace

Skeleton buildSkeleton(double depthScale) {
  Skeleton skeleton;
  skeleton.sternum = sternumPlan(depthScale);
  for (int number = 1; number <= 12; ++number)
    for (Side side : {Side::right, Side::left})
      skeleton.ribs.push_back({side, number, 0, ribLine(number, side == Side::right ? -1 : 1, depthScale)});
  for (int number = 1; number <= 10; ++number)
    for (Side side : {Side::right, Side::left}) {
      const std::vector<Vec3>* upper = number > 7 ? &skeleton.cartilages[skeleton.cartilages.size() - 2].line : nullptr;
      skeleton.cartilages.push_back(cartilage(skeleton, side, number, upper));
    }
  return skeleton;
}

double junctionX(const Skeleton& skeleton, double z) {
  // Newton's parabola through the junctions of ribs 1, 4 and 10: smooth, and within a few mm of the others.
  const Vec3 a = skeleton.ribs[1].line.back(), b = skeleton.ribs[7].line.back(), c = skeleton.ribs[19].line.back();
  const double ab = (b.x - a.x) / (b.z - a.z), bc = (c.x - b.x) / (c.z - b.z);
  const double x = a.x + ab * (z - a.z) + (bc - ab) / (c.z - a.z) * (z - a.z) * (z - b.z);
  return z > a.z ? a.x : z < c.z ? c.x : x;
}

}  // namespace pectora::phantom
