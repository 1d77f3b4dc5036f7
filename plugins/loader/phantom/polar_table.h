// A closed surface around the body as a smooth table r(angle, z) in polar coordinates.
#pragma once

#include "kernel/value/vec3.h"

#include <vector>

namespace pectora::phantom {

/// Where the polar coordinates of level z have their centre (on the sagittal plane): within the chest, further back
/// towards the neck. Body frame, mm.
double polarCenterY(double z);

/// Angle from straight ahead (0), over the patient's left (pi/2), to straight behind (pi or -pi).
double polarAngle(double x, double y, double z);

/// A point that the surface passes through, and how much it weighs.
struct PolarSample {
  Vec3 point;
  double weight = 1;
};

/// r(angle, z), one value each degree and each 2 mm. Bilinear between.
class PolarTable {
 public:
  static constexpr int kAngles = 360;
  static constexpr double kBottom = -520, kTop = 80, kStep = 2;

  /// The smoothest left-right symmetric surface (least squares with second differences as penalty) through samples.
  static PolarTable fit(const std::vector<PolarSample>& samples);
  /// The table whose value is f(angle, z).
  template <class F>
  static PolarTable of(F&& f) {
    PolarTable table;
    for (int j = 0; j < table.levels(); ++j)
      for (int i = 0; i < kAngles; ++i) table.value(i, j) = f(table.angle(i), table.level(j));
    return table;
  }

  PolarTable();
  double radius(double angle, double z) const;
  /// The surface's point at that angle and level.
  Vec3 at(double angle, double z) const;
  /// One level of the table: kAngles + 1 radii, the last equal to the first; node i is angle -180 deg + i deg.
  std::vector<float> levelRadii(double z) const;
  /// 1 / |gradient of (r - table)| for the nodes of levelRadii: turns a radial distance into one along the normal.
  std::vector<float> levelNormalFactors(double z) const;
  /// The same at any place.
  double normalFactor(double angle, double z) const;
  /// Smooths with `passes` of a three-point binomial filter in both directions.
  void smooth(int passes);

 private:
  int levels() const;
  static double angle(int i);
  static double level(int j) { return kBottom + j * kStep; }
  double& value(int i, int j) { return values_[std::size_t(j) * kAngles + (i % kAngles + kAngles) % kAngles]; }
  double value(int i, int j) const { return const_cast<PolarTable*>(this)->value(i, j); }
  std::vector<double> values_;
};

}  // namespace pectora::phantom
