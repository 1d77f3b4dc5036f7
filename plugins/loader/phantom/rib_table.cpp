#include "rib_table.h"

#include "smooth.h"

namespace pectora::phantom {

const RibRow& ribRow(int number) {
  static const RibRow rows[12] = {
      {0, 116, 85, 28, 118, -32, 35},    {-18, 178, 125, 30, 195, 0, 42},  {-38, 212, 152, 32, 240, 28, 48},
      {-59, 234, 168, 34, 266, 52, 56},  {-81, 248, 179, 36, 280, 72, 70}, {-104, 258, 191, 38, 284, 87, 98},
      {-127, 264, 203, 39, 284, 97, 125}, {-150, 266, 206, 40, 272, 0, 110}, {-174, 262, 205, 40, 250, 0, 85},
      {-198, 252, 221, 39, 218, 0, 60},  {-222, 244, 214, 39, 190, 0, 0},  {-246, 236, 208, 38, 110, 0, 0}};
  return rows[number - 1];
}

SternumPlan sternumPlan(double depthScale) {
  SternumPlan plan;
  // The table's depths are counted from the ribs' backs.
  plan.joint = {0, kRibBack - (91 + kRibBack) * depthScale, -86};
  return plan;
}

Vec3 SternumPlan::at(double s) const {
  const double tilt = tiltAt(s);
  return joint + Vec3{0, -s * std::sin(tilt), -s * std::cos(tilt)};
}

double SternumPlan::arcAt(double z) const {
  return (joint.z - z) / std::cos(radians(z > joint.z ? manubriumTiltDeg : bodyTiltDeg));
}

double SternumPlan::tiltAt(double s) const { return radians(s < 0 ? manubriumTiltDeg : bodyTiltDeg); }

double SternumPlan::halfWidth(double s) const {
  const double xs[] = {-51, -40, -28, 0, 60, 90, 102, 106, 132};
  const double widths[] = {46, 60, 56, 36, 38, 40, 30, 17, 8};
  return piecewise(xs, widths, s) / 2;
}

double SternumPlan::thickness(double s) const {
  const double xs[] = {-51, 0, 98, 106, 132};
  const double values[] = {12, 11, 9, 6, 4};
  return piecewise(xs, values, s);
}

}  // namespace pectora::phantom
