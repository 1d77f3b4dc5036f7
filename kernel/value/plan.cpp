#include "kernel/value/plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pectora {
namespace {

// A cubic piece with both end handles scaled, ends and end tangents kept.
Curve withHandles(Curve curve, double scale) {
  std::vector<Vec3>& p = curve.controls;
  p[1] = lerp(p[0], p[1], scale);
  p[2] = lerp(p[3], p[2], scale);
  return curve;
}

// Scales the handles until the curve has the wanted length, or comes as close as handles between half and one and a half
// times their length allow: beyond that it would kink. Longer handles make a longer curve, so bisection finds it.
Curve withLength(const Curve& curve, double length) {
  double low = 0.8, high = 1.2;
  if (withHandles(curve, low).length() >= length) return withHandles(curve, low);
  if (withHandles(curve, high).length() <= length) return withHandles(curve, high);
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (withHandles(curve, middle).length() < length ? low : high) = middle;
  }
  return withHandles(curve, 0.5 * (low + high));
}

}  // namespace

Vec3 RigidMotion::rotate(Vec3 d) const {
  const double c = std::cos(angle), s = std::sin(angle);
  return d * c + cross(axis, d) * s + axis * (dot(axis, d) * (1 - c));
}

std::vector<MovedCartilage> followSternum(const RibCage& cage, const RigidMotion& sternum) {
  std::vector<MovedCartilage> moved;
  for (const Cartilage& cartilage : cage.cartilages) {
    const Curve& rest = cartilage.curve;
    // Where the medial end goes: with the sternum, or with the cartilage that it joins (already moved).
    const Vec3 end = rest.controls.back();
    Vec3 endMove = sternum(end) - end;
    bool rotates = true;
    if (cartilage.joins > 0) {
      for (std::size_t i = 0; i < moved.size(); ++i) {
        const Cartilage& other = cage.cartilages[i];
        if (other.side != cartilage.side || other.rib != cartilage.joins) continue;
        endMove = moved[i].curve.at(cartilage.joinsAt) - other.curve.at(cartilage.joinsAt);
        rotates = false;
      }
    }
    // The rib's end stays with its handle; the other end takes its handle along.
    Curve curve = rest;
    curve.controls[3] = end + endMove;
    curve.controls[2] = rotates ? sternum(rest.controls[2]) : rest.controls[2] + endMove;
    const double length = rest.length();
    const bool still = norm(endMove) < 1e-12;
    MovedCartilage result{still ? curve : withLength(curve, length), 0};
    result.strain = length > 0 ? (result.curve.length() - length) / length : 0;
    moved.push_back(std::move(result));
  }
  return moved;
}

RigidMotion Plan::partial(double t) const {
  RigidMotion part = motion;
  part.angle *= t;
  part.translation *= t;
  return part;
}

Vec3 Plan::moved(const Anchor& anchor, double t) const {
  switch (anchor.body) {
    case BodyKind::rib:
    case BodyKind::still:
      return anchor.rest;
    case BodyKind::sternum:
      return partial(t)(anchor.rest);
    case BodyKind::cartilage: {
      // Between two frames the curve is interpolated; the anchor keeps its offset from the curve.
      const double position = std::clamp(t, 0.0, 1.0) * double(frames.size() - 1);
      const std::size_t frame = std::min(frames.size() - 2, std::size_t(position));
      const auto at = [&](std::size_t f) { return frames[f][anchor.index].curve.at(anchor.u); };
      return anchor.rest + lerp(at(frame), at(frame + 1), position - double(frame)) - at(0);
    }
  }
  return anchor.rest;
}

std::vector<Fact> Plan::facts() const {
  double worst = 0;
  if (!frames.empty())
    for (const MovedCartilage& c : frames.back())
      if (std::abs(c.strain) > std::abs(worst)) worst = c.strain;
  return {{"lift", lift, "mm"},
          {"angle", motion.angle * 180 / std::numbers::pi, "deg"},
          {"pivot_z", motion.pivot.z, "mm"},
          {"deepest_x", deepest.x, "mm"},
          {"deepest_y", deepest.y, "mm"},
          {"deepest_z", deepest.z, "mm"},
          {"intercostal_space", double(intercostalSpace), ""},
          {"worst_cartilage_strain", 100 * worst, "%"}};
}

std::vector<std::pair<std::string, std::shared_ptr<const Value>>> Plan::parts() const { return {{"cage", cage}}; }

}  // namespace pectora
