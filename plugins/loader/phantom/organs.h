// Lungs, heart, great vessels, liver and spine as signed distances in the undeformed body frame, mm, negative inside.
#pragma once

#include "rib_table.h"

#include <vector>

namespace pectora::phantom {

/// Distances of the organs at one point.
struct OrganDistances {
  double mediastinum, heart, vessels, airway;
};

/// The organs of the trunk. The heart is pushed to the left by `heartShift` mm (as a deep pit does).
class Organs {
 public:
  explicit Organs(double heartShift) : heartShift_(heartShift) {}
  OrganDistances at(Vec3 p) const;
  /// Distance below the lungs' limits: the apex above and the diaphragm below; negative between them.
  double lungLimits(Vec3 p) const;
  /// Distance to the diaphragm: positive above it.
  double aboveDiaphragm(Vec3 p) const;
  /// Inside of the liver, apart from the limits that diaphragm and abdominal wall give.
  double liver(Vec3 p) const;

 private:
  double heartShift_;
};

/// The spine at one level.
class SpineLevel {
 public:
  explicit SpineLevel(double z);
  /// Whether a point can be within 3 mm of the spine at all.
  static bool isNear(double x, double y) { return y > kVertebralFront - 3 && y < 62 && x > -40 && x < 40; }
  double bone(double x, double y) const;   ///< body, arch and processes
  double body(double x, double y) const;   ///< vertebral body or disc alone
  double canal(double x, double y) const;
  bool isDisc() const { return isDisc_; }
  /// Distance to the nearest end plate, mm.
  double toEndPlate() const { return toEndPlate_; }

 private:
  struct Capsule {
    Vec3 start, end;
    double radius;
  };
  double z_, waist_, toEndPlate_;
  bool isDisc_;
  std::vector<Capsule> processes_;
};

}  // namespace pectora::phantom
