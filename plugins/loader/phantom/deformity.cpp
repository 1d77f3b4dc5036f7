#include "deformity.h"

#include "smooth.h"

namespace pectora::phantom {
namespace {

constexpr double kPivotMm = 160;      // pivot cranial of the deepest point, science.md section 3
constexpr double kTwist = 0.6;         // part of a lopsided pit that turns the sternum; cartilages bend for the rest
constexpr double kDecayFrom = 108;    // below the sternal body the pit runs out into the epigastrium
constexpr double kDecayTo = 200;

}  // namespace

Deformity::Deformity(const Skeleton& skeleton, const PitShape& shape) : skeleton_(&skeleton), shape_(shape) {
  switch (shape.type) {
    case PitType::cup: exponent_ = 2, width_ = 38, riseFrom_ = -10, riseTo_ = 85; break;
    case PitType::asymmetric: exponent_ = 2, width_ = 42, riseFrom_ = -10, riseTo_ = 85; break;
    case PitType::saucer: exponent_ = 4, width_ = 70, riseFrom_ = -10, riseTo_ = 70; break;
    case PitType::trench: exponent_ = 2, width_ = 25, riseFrom_ = -45, riseTo_ = 5; break;
  }
  // Wavelength of the pit as four half widths: 100 mm gives 0.8, 280 mm 0.95.
  skinShare_ = 0.8 + 0.15 * std::clamp((4 * width_ - 100) / 180, 0.0, 1.0);
  const double deepestS = shape.type == PitType::trench ? 70 : riseTo_;
  deepestZ_ = skeleton.sternum.at(deepestS).z;

  // The profile counts as 1 where the sternum lies deepest.
  DeformityLevel level = at(deepestZ_);
  level.amount = 1, level.torsionSlope = 0;
  deepestX_ = std::abs(level.slope) < 1e-9 ? 0 : std::copysign(level.plate, level.slope);
  norm_ = std::max(1e-6, level.bone(deepestX_));
  skinGain_ = skinShare_ * norm_ / std::max(1e-6, evenedOut([&](double x) { return level.bone(x); }, deepestX_));
}

double DeformityLevel::raw(double x) const {
  const double from = x - centerX;
  const double fade = step(junction, 0.45 * junction, std::abs(x));
  return std::exp(-std::pow(std::abs(from) / (from < 0 ? widthRight : widthLeft), exponent)) * fade;
}

double DeformityLevel::bone(double x) const {
  // Beyond the sternum's edge the rigid plate goes over into the pit's own shape.
  const double edge = std::clamp(x, -plate, plate);
  const double within = mean + slope * edge;
  const double beyond = step(junction, plate, std::abs(x));
  const double shape = x == edge ? within : raw(x) + (within - raw(edge)) * beyond;
  return amount * shape + torsionSlope * edge * beyond;
}

DeformityLevel Deformity::at(double z) const {
  const double s = skeleton_->sternum.arcAt(z);
  DeformityLevel level;
  // A trench runs obliquely, further from the midline below.
  level.centerX = shape_.eccentricity * (shape_.type == PitType::trench ? 0.5 + step(-45, 110, s) : 1);
  level.widthRight = width_ * (1 + shape_.asymmetry);
  level.widthLeft = width_ * (1 - shape_.asymmetry);
  level.exponent = exponent_;
  const double at[] = {-51, -28, -5, 100, 132}, halves[] = {30, 29, 19.5, 19.5, 9};
  level.plate = piecewise(at, halves, s);
  level.junction = std::max(junctionX(*skeleton_, z), level.plate + 8);

  // Regression of the raw profile over the sternum's width.
  double sum = 0, moment = 0, squares = 0;
  for (int i = -4; i <= 4; ++i) {
    const double x = level.plate * i / 4, value = level.raw(x);
    sum += value, moment += value * x, squares += x * x;
  }
  level.mean = sum / 9;
  level.slope = kTwist * moment / squares;

  const double remaining = shape_.depth > 0 ? std::clamp(1 - shape_.lift / shape_.depth, 0.0, 1.0) : 0;
  level.amount = (shape_.depth * along(z) - shape_.lift * elevation(z)) / norm_;
  level.torsionSlope = std::tan(radians(shape_.torsionDeg)) * along(z) * remaining;
  return level;
}

double Deformity::along(double z) const {
  const double s = skeleton_->sternum.arcAt(z);
  return step(riseFrom_, riseTo_, s) * step(kDecayTo, kDecayFrom, s);
}

double Deformity::elevation(double z) const {
  const double turned = std::max(0.0, (deepestZ_ + kPivotMm - z) / kPivotMm);
  return turned * step(kDecayTo, kDecayFrom, skeleton_->sternum.arcAt(z));
}

}  // namespace pectora::phantom
