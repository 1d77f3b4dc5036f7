// The pit and its correction: how far the front wall stands behind (or before) that of the normal chest.
#pragma once

#include "torso.h"

#include <array>
#include <string>

namespace pectora::phantom {

enum class PitType { cup, saucer, trench, asymmetric };

/// Shape and size of the deformity, mm of the unscaled body.
struct PitShape {
  PitType type = PitType::cup;
  double depth = 0;       ///< d_p, displacement of the bone at the deepest point
  double eccentricity = 0;  ///< x of the deepest point relative to the midline; negative: to the right
  double asymmetry = 0;   ///< (right half width - left) / (right + left), -0.8 to 0.8
  double torsionDeg = 0;  ///< rotation of the sternum's section about its axis; positive: left side deeper
  double lift = 0;        ///< elevation of the deepest point by the operation
};

/// Displacement of the bony front wall towards the back (science.md, section 1):
/// delta(x, s) = d_p A(x) B(s), A = exp(-|(x - x0) / w|^n), B a C1 rise to s0 along the sternum; only sternum and
/// cartilages move, a cubic Hermite brings it to 0 at the costochondral junctions. The operation turns the sternum
/// about a pivot 160 mm cranial of the deepest point (section 3) and turns the torsion back in proportion.
class Deformity {
 public:
  Deformity(const Skeleton& skeleton, const PitShape& shape);
  /// Displacement of bone at (x, z), mm, positive towards the back.
  double bone(double x, double z) const;
  /// Part of the bone's displacement that the skin follows, 0.8 (narrow pits) to 0.95 (wide ones).
  double skinShare() const { return skinShare_; }
  /// Displacement of the skin at (x, z): the bone's across the body, evened out as the fat does (a Gaussian of 9 mm),
  /// with skinShare() of the bone's at the deepest place.
  double skin(double x, double z) const { return skinGain_ * evened(x, z); }
  /// Level of the deepest point, and its x.
  double deepestZ() const { return deepestZ_; }
  double deepestX() const { return centerX(deepestZ_); }

 private:
  double centerX(double z) const;
  double across(double x, double z) const;
  double along(double z) const;
  double elevation(double z) const;
  double fade(double x, double z) const;
  double evened(double x, double z) const;

  const Skeleton* skeleton_;
  PitShape shape_;
  double exponent_, width_, riseFrom_, riseTo_, skinShare_, skinGain_, deepestZ_;
};

}  // namespace pectora::phantom
