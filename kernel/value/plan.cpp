#include "kernel/value/plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pectora {
namespace {

// Smoothstep: 0 at 0, 1 at 1, flat at both.
double fade(double s) { return s * s * (3 - 2 * s); }

// The parameter at which a control point has its greatest influence.
double greville(const Curve& curve, int control) {
  double sum = 0;
  for (int k = 1; k <= curve.degree; ++k) sum += curve.knots[control + k];
  return sum / curve.degree;
}

// Moves the inner end handles to `scale` times their length, keeping ends and end tangents.
Curve withHandles(Curve curve, double scale) {
  std::vector<Vec3>& p = curve.controls;
  const std::size_t n = p.size();
  p[1] = lerp(p[0], p[1], scale);
  p[n - 2] = lerp(p[n - 1], p[n - 2], scale);
  return curve;
}

// Scales the handles until the curve has the wanted length, or comes as close as handles between 0.3 and 2.5 times
// their length allow. Longer handles make a longer curve here, so bisection finds it.
Curve withLength(const Curve& curve, double length) {
  double low = 0.3, high = 2.5;
  if (withHandles(curve, low).length() >= length) return withHandles(curve, low);
  if (withHandles(curve, high).length() <= length) return withHandles(curve, high);
  for (int i = 0; i < 40; ++i) {
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
    // Control points fade from fixed at the rib to moving with the end.
    Curve curve = rest;
    for (std::size_t i = 0; i < curve.controls.size(); ++i) {
      const Vec3 p = rest.controls[i];
      const Vec3 full = rotates ? sternum(p) - p : endMove;
      curve.controls[i] = p + full * fade(greville(rest, int(i)));
    }
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
