// The bar's course across the chest.
#pragma once

#include "kernel/value/plan.h"

namespace pectora {

struct BarSettings {
  double width = 12.7, height = 3.5;   ///< section of the bar, mm
  double flat = 30;                    ///< length of the straight part behind the sternum, mm
};

/// The bar at the height of `deepest`: behind the lifted sternum in the middle, over the ribs' outer side to the mid-axillary lines at
/// its ends; a smooth convex curve. `motion` is the sternum's.
Bar shapeBar(const RibCage& cage, Vec3 deepest, const RigidMotion& motion, const BarSettings& settings);

}  // namespace pectora
