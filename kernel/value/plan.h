// What the operation does to the rib cage: how the sternum moves, where the bar lies.
#pragma once

#include "kernel/value/scene.h"

namespace pectora {

/// A rigid motion: rotation by `angle` radians about the axis through `pivot`, then a translation.
struct RigidMotion {
  Vec3 pivot;
  Vec3 axis{1, 0, 0};   ///< unit
  double angle = 0;     ///< rad, right-handed
  Vec3 translation;

  Vec3 operator()(Vec3 p) const { return pivot + rotate(p - pivot) + translation; }
  /// Part t (0 to 1) of the motion: angle and translation are scaled.
  RigidMotion part(double t) const;
  /// Rotates a direction (Rodrigues).
  Vec3 rotate(Vec3 d) const;
};

/// A cartilage after the sternum has moved.
struct MovedCartilage {
  Curve curve;
  double strain = 0;   ///< (new arc length - old) / old
};

/// Carries every cartilage along with the sternum. The costochondral end stays with its tangent, the medial end moves
/// with the sternum (rigidly) or with the cartilage that it joins, and control points between follow like a beam clamped at both ends:
/// by 3 s^2 - 2 s^3 of the end's displacement at the part s of the length. Where that makes it longer, the bow
  /// between the ends is flattened until the arc length is the old one; what remains is reported as strain. It is large in
  /// the short first and second cartilages, because no rib moves here: in a body the upper ribs come along with the manubrium.
/// Returns one entry for each of cage.cartilages, in order.
std::vector<MovedCartilage> followSternum(const RibCage& cage, const RigidMotion& sternum);

/// A bar: a curve across the chest behind the sternum in a plane that holds the y axis, its rectangular section, and what it does.
struct Bar {
  Vec3 point{};                   ///< of the sternum's front that it lifts, before
  double lift = 0;                ///< forward displacement of that point, mm
  std::vector<Vec3> centerline{}; ///< from right to left, mm; in place
  Vec3 up{0, 0, 1};               ///< unit normal of its plane, the way of its width; y = 0
  double width = 12.7;            ///< along `up`, mm
  double height = 3.5;            ///< thickness, mm
  int rightSpace = 0, leftSpace = 0;   ///< it lies below this rib on that side; 0 if the ribs there were not found

  /// How far its left end lies above its right one, degrees.
  double tiltDeg() const;
};

struct Plan : Value {
  static constexpr const char* kName = "Plan";
  std::shared_ptr<const RibCage> cage;
  std::vector<Bar> bars;           ///< one or two
  RigidMotion motion;              ///< of the sternum, complete
  /// The cartilages at equal steps of the motion, from rest (first) to complete (last).
  std::vector<std::vector<MovedCartilage>> frames;

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
  std::vector<std::pair<std::string, std::shared_ptr<const Value>>> parts() const override;
  /// Of the first bar, mm; 0 without one.
  double lift() const { return bars.empty() ? 0 : bars.front().lift; }
  /// Where an anchor lies after part t of the motion.
  Vec3 moved(const Anchor& anchor, double t) const;
};

}  // namespace pectora
