// The figures of science.md, section 1: twelve ribs and the sternum of a boy of 16.8 years.
#pragma once

#include "kernel/value/vec3.h"

namespace pectora::phantom {

/// One row of the table. Rib i lies in a plane through the x axis that is tilted caudally by `tiltDeg`.
struct RibRow {
  double z;          ///< level of the rib's head, mm
  double width;      ///< W, mm
  double depth;      ///< D, mm
  double tiltDeg;    ///< alpha, pump-handle angle
  double length;     ///< L, arc length from head to costochondral junction, mm
  double notch;      ///< ribs 1-7: arc coordinate s of the notch along the sternum, mm
  double cartilage;  ///< Lc, mm; 0 for a floating rib
};

/// The row of rib `number`, 1 to 12.
const RibRow& ribRow(int number);

/// Sternum of the undeformed chest in its sagittal plane, body frame (LPS, y = 0 at the vertebral centres).
struct SternumPlan {
  Vec3 joint;                       ///< manubriosternal joint (angle of Louis)
  double manubriumTiltDeg = 38;     ///< from the vertical
  double bodyTiltDeg = 20;
  double manubriumLength = 51;      ///< mm
  double bodyLength = 102;
  double xiphoidLength = 30;

  /// Point of the mid-line at arc coordinate s: negative along the manubrium, positive along body and xiphoid.
  Vec3 at(double s) const;
  /// Arc coordinate of the level z.
  double arcAt(double z) const;
  /// Angle from the vertical at s, radians.
  double tiltAt(double s) const;
  double halfWidth(double s) const;
  double thickness(double s) const;
  double top() const { return -manubriumLength; }
  double bottom() const { return bodyLength + xiphoidLength; }
};

/// The sternum for a chest whose depth is scaled by `depthScale`.
SternumPlan sternumPlan(double depthScale);

constexpr double kRibHeight = 13, kRibThickness = 7;               ///< rib's section, mm
constexpr double kCartilageHeight = 14, kCartilageThickness = 10;  ///< cartilage's section, mm
constexpr double kPleuraBehindRib = 1.5;                           ///< pleura = inner rib surface + 1.5 mm
constexpr double kVertebralFront = -14;                            ///< y of the front of the vertebral bodies, mm
constexpr double kRibBack = 32;                                    ///< y of the plane that the ribs start from, mm

}  // namespace pectora::phantom
