// A bar's course across the chest.
#pragma once

#include "kernel/value/plan.h"

namespace pectora {

struct BarSettings {
  double width = 12.7, height = 3.5;   ///< section of the bar, mm
  double flat = 30;                    ///< length of the straight part behind the sternum, mm
};

/// The bar that lifts `point` of the sternum's front by `lift`: behind the lifted sternum in the middle, over the ribs' outer side to
/// the mid-axillary lines at its ends; a smooth convex curve in the plane through the lifted point whose left side rises by
/// `tiltDeg`. `motion` is the sternum's.
Bar shapeBar(const RibCage& cage, Vec3 point, double lift, const RigidMotion& motion, double tiltDeg, const BarSettings& settings);

/// Number of the rib above the intercostal space that a bar passes on one side of the sternum: the lowest whose notch there lies
/// above the plane through `point` with the unit normal `up`. 0 if none does.
int intercostalSpace(const Sternum& sternum, Side side, Vec3 point, Vec3 up);

}  // namespace pectora
