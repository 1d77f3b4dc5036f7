#include "deformity.h"

#include "smooth.h"

namespace pectora::phantom {
namespace {

constexpr double kPivotMm = 160;      // pivot cranial of the deepest point, science.md section 3
constexpr double kEvenMm = 9;         // how far the fat evens out the bone's displacement
constexpr double kDecayFrom = 108;    // below the sternal body the pit runs out into the epigastrium
constexpr double kDecayTo = 200;

}  // namespace

Deformity::Deformity(const Skeleton& skeleton, const PitShape& shape) : skeleton_(&skeleton), shape_(shape) {
  switch (shape.type) {
    case PitType::cup: exponent_ = 2, width_ = 38, riseFrom_ = -10, riseTo_ = 85; break;
    case PitType::asymmetric: exponent_ = 2, width_ = 42, riseFrom_ = -10, riseTo_ = 85; break;
    case PitType::saucer: exponent_ = 4, width_ = 70, riseFrom_ = -10, riseTo_ = 70; break;
    case PitType::trench: exponent_ = 2, width_ = 25, riseFrom_ = -85, riseTo_ = -45; break;
  }
  // Wavelength of the pit as four half widths: 100 mm gives 0.8, 280 mm 0.95.
  skinShare_ = 0.8 + 0.15 * std::clamp((4 * width_ - 100) / 180, 0.0, 1.0);
  const double deepestS = shape.type == PitType::trench ? 70 : riseTo_;
  deepestZ_ = skeleton.sternum.at(deepestS).z;
  const double deepest = bone(deepestX(), deepestZ_), evenedDeepest = evened(deepestX(), deepestZ_);
  skinGain_ = evenedDeepest != 0 ? skinShare_ * deepest / evenedDeepest : skinShare_;
}

double Deformity::evened(double x, double z) const {
  double sum = 0, weights = 0;
  for (double offset = -18; offset <= 18; offset += 3) {
    const double weight = std::exp(-offset * offset / (2 * kEvenMm * kEvenMm));
    sum += weight * bone(x + offset, z);
    weights += weight;
  }
  return sum / weights;
}

double Deformity::centerX(double z) const {
  if (shape_.type != PitType::trench) return shape_.eccentricity;
  // A trench runs obliquely, further from the midline below.
  return shape_.eccentricity * (0.5 + step(-45, 110, skeleton_->sternum.arcAt(z)));
}

double Deformity::across(double x, double z) const {
  const double from = x - centerX(z);
  const double width = width_ * (1 + (from < 0 ? shape_.asymmetry : -shape_.asymmetry));
  return std::exp(-std::pow(std::abs(from) / width, exponent_)) * fade(x, z);
}

double Deformity::fade(double x, double z) const {
  const double junction = junctionX(*skeleton_, z);
  return step(junction, 0.45 * junction, std::abs(x));
}

double Deformity::along(double z) const {
  const double s = skeleton_->sternum.arcAt(z);
  return step(riseFrom_, riseTo_, s) * step(kDecayTo, kDecayFrom, s);
}

double Deformity::elevation(double z) const {
  const double s = skeleton_->sternum.arcAt(z);
  const double turned = std::clamp((deepestZ_ + kPivotMm - z) / kPivotMm, 0.0, 1.0);
  return turned * step(kDecayTo, kDecayFrom, s);
}

double Deformity::bone(double x, double z) const {
  const double shape = across(x, z);
  const double remaining = shape_.depth > 0 ? std::clamp(1 - shape_.lift / shape_.depth, 0.0, 1.0) : 0;
  const double torsion = std::tan(radians(shape_.torsionDeg)) * x * bell(x, 45) * fade(x, z) * along(z) * remaining;
  return (shape_.depth * along(z) - shape_.lift * elevation(z)) * shape + torsion;
}

}  // namespace pectora::phantom
