// The pit and its correction: how far the front wall stands behind (or before) that of the normal chest.
#pragma once

#include "torso.h"

#include <cmath>

namespace pectora::phantom {

enum class PitType { cup, saucer, trench, asymmetric };

/// Shape and size of the deformity, mm of the unscaled body.
struct PitShape {
  PitType type = PitType::cup;
  double depth = 0;       ///< d_p, displacement of the bone at the deepest point
  double eccentricity = 0;  ///< x of the deepest point relative to the midline; negative: to the right
  double asymmetry = 0;   ///< (right half width - left) / (right + left), -0.7 to 0.7
  double torsionDeg = 0;  ///< rotation of the sternum's section about its axis; positive: left side deeper
  double lift = 0;        ///< elevation of the deepest point by the operation
};

/// The deformity at one level: displacement towards the back, mm.
class DeformityLevel {
 public:
  /// Of bone and cartilage at x.
  double bone(double x) const;

 private:
  friend class Deformity;
  double raw(double x) const;
  double centerX, widthRight, widthLeft, exponent;  // of A(x)
  double junction, plate;                            // half distances: of the junctions, of the rigid sternum
  double mean = 0, slope = 0;                        // of A over the sternum
  double amount, torsionSlope;
};

/// Displacement of the bony front wall towards the back (science.md, section 1):
/// delta(x, s) = d_p A(x) B(s), A = exp(-|(x - x0) / w|^n), B a C1 rise to s0 along the sternum; only sternum and
/// cartilages move, a cubic Hermite brings it to 0 at the costochondral junctions. The sternum stays a rigid plate
/// across: over its width A is replaced by its line of regression. The operation turns the sternum about a pivot
/// 160 mm cranial of the deepest point (section 3) and turns the torsion back in proportion.
class Deformity {
 public:
  Deformity(const Skeleton& skeleton, const PitShape& shape);
  DeformityLevel at(double z) const;
  /// What the skin follows, as a factor on the bone's displacement after the fat has evened it out (a Gaussian of
  /// kEvenMm across the body). At the deepest place the skin follows by skinShare() of the bone.
  double skinGain() const { return skinGain_; }
  /// 0.8 for narrow pits to 0.95 for wide ones.
  double skinShare() const { return skinShare_; }
  /// A(x) at the deepest place of the sternum: near 0 if the pit lies beside it.
  double sternalShare() const { return norm_; }
  /// Where the pit is deepest (the sternum's edge if it is turned), body frame.
  double deepestX() const { return deepestX_; }
  double deepestZ() const { return deepestZ_; }

  static constexpr double kEvenMm = 9;

 private:
  double along(double z) const;
  double elevation(double z) const;

  const Skeleton* skeleton_;
  PitShape shape_;
  double exponent_, width_, riseFrom_, riseTo_, skinShare_, skinGain_ = 1, deepestX_ = 0, deepestZ_, norm_ = 1;
};

/// The mean of f over x, weighted by the Gaussian that the fat evens displacements out with.
template <class F>
double evenedOut(F&& f, double x) {
  double sum = 0, weights = 0;
  for (int offset = -18; offset <= 18; offset += 3) {
    const double weight = std::exp(-offset * offset / (2 * Deformity::kEvenMm * Deformity::kEvenMm));
    sum += weight * f(x + offset);
    weights += weight;
  }
  return sum / weights;
}

}  // namespace pectora::phantom
