#include "kernel/value/plan.h"

#include "kernel/value/indices.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pectora {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// Deflection of a clamped beam whose other end is guided: 0 to 1, flat at both ends.
double beam(double s) { return s * s * (3 - 2 * s); }

// The parameter at which a control point has its greatest influence.
double greville(const Curve& curve, std::size_t control) {
  double sum = 0;
  for (int k = 1; k <= curve.degree; ++k) sum += curve.knots[control + k];
  return sum / curve.degree;
}

// Scales how far the inner control points bow away from the chord; ends and end tangents (the outer two at each end) stay.
Curve withBow(const Curve& curve, double scale) {
  Curve bowed = curve;
  const std::size_t n = curve.controls.size();
  for (std::size_t i = 2; i + 2 < n; ++i) {
    const Vec3 chord = lerp(curve.controls.front(), curve.controls.back(), greville(curve, i));
    bowed.controls[i] = lerp(chord, curve.controls[i], scale);
  }
  return bowed;
}

// The bow that gives the wanted length, or comes as close as flattening it can. It is never raised: a cartilage that is
// too long now pushes its rib aside rather than arching forwards.
Curve withLength(const Curve& curve, double length) {
  const Curve flat = withBow(curve, 0);
  double low = 0, high = 1, tooShort = flat.length() - length, tooLong = curve.length() - length;
  if (tooShort >= 0) return flat;
  if (tooLong <= 0) return curve;
  // Between the two by the chord, where one end is kept twice with half its weight (the Illinois rule).
  Curve bowed = curve;
  for (int i = 0, last = 0; i < 50; ++i) {
    const double scale = (low * tooLong - high * tooShort) / (tooLong - tooShort);
    bowed = withBow(curve, scale);
    const double off = bowed.length() - length;
    if (std::abs(off) < 1e-10 * length) break;
    const int side = off < 0 ? -1 : 1;
    if (side < 0) low = scale, tooShort = off, tooLong *= last < 0 ? 0.5 : 1;
    else high = scale, tooLong = off, tooShort *= last > 0 ? 0.5 : 1;
    last = side;
  }
  return bowed;
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
    // Control points follow by their place along the curve; the outer two at each end go with the ends.
    Curve curve = rest;
    const std::size_t n = rest.controls.size();
    for (std::size_t i = 2; i < n; ++i) {
      const Vec3 p = rest.controls[i];
      const Vec3 full = rotates ? sternum(p) - p : endMove;
      curve.controls[i] = p + full * (i + 2 >= n ? 1 : beam(greville(rest, i)));
    }
    const double length = rest.length();
    const bool still = norm(endMove) < 1e-12;
    MovedCartilage result{still ? curve : withLength(curve, length), 0};
    result.strain = length > 0 ? (result.curve.length() - length) / length : 0;
    moved.push_back(std::move(result));
  }
  return moved;
}

RigidMotion RigidMotion::part(double t) const {
  RigidMotion scaled = *this;
  scaled.angle *= t;
  scaled.translation *= t;
  return scaled;
}

double Bar::tiltDeg() const { return std::atan2(-up.x, up.z) * kDegrees; }

Vec3 Plan::moved(const Anchor& anchor, double t) const {
  switch (anchor.body) {
    case BodyKind::rib:
    case BodyKind::still:
      return anchor.rest;
    case BodyKind::sternum:
      return motion.part(t)(anchor.rest);
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
  const PlannedIndices* indices = nullptr;
  std::optional<PlannedIndices> planned;
  if (cage && cage->anatomy && (planned = plannedIndices(*cage->anatomy, motion))) indices = &*planned;
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<Fact> facts{{"bars", double(bars.size()), ""}};
  for (const Bar& bar : bars) {
    const std::string which = &bar == &bars.front() ? "" : "second_";
    facts.insert(facts.end(), {{which + "lift", bar.lift, "mm"},
                               {which + "point_x", bar.point.x, "mm"},
                               {which + "point_y", bar.point.y, "mm"},
                               {which + "point_z", bar.point.z, "mm"},
                               {which + "tilt", bar.tiltDeg(), "deg"},
                               {which + "intercostal_space_right", double(bar.rightSpace), ""},
                               {which + "intercostal_space_left", double(bar.leftSpace), ""}});
  }
  facts.insert(facts.end(), {{"angle", motion.angle * kDegrees, "deg"},
                             {"shift", -motion.translation.y, "mm"},
                             {"pivot_z", motion.pivot.z, "mm"},
                             {"worst_cartilage_strain", 100 * worst, "%"},
                             {"depression", indices ? indices->after.depression() : none, "mm"},
                             {"haller_index", indices ? indices->after.haller() : none, ""},
                             {"correction_index", indices ? indices->after.correctionIndex() : none, "%"},
                             {"depression_before", indices ? indices->before.depression() : none, "mm"},
                             {"haller_index_before", indices ? indices->before.haller() : none, ""},
                             {"correction_index_before", indices ? indices->before.correctionIndex() : none, "%"}});
  return facts;
}

std::vector<std::pair<std::string, std::shared_ptr<const Value>>> Plan::parts() const { return {{"cage", cage}}; }

}  // namespace pectora
