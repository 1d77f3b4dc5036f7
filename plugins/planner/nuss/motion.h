// How the bar turns the sternum.
#pragma once

#include "kernel/value/plan.h"

#include <string>

namespace pectora {

enum class Pivot {
  sternoclavicular,   ///< an axis above the sternum: fits measured elevations (38.6, 28.4, 19.4 mm at 0, 4, 8 cm)
  manubrium,          ///< the manubriosternal joint, as in Moreira et al. 2012
};

/// The rotation about the transverse axis through the pivot that brings `deepest` forward by `lift` mm (y falls by it).
/// `pivotDistance` is how far the sternoclavicular axis lies above the deepest point, mm; the manubrial axis runs through
/// the sternum's joint. Throws Error if no rotation below 60 degrees lifts so far.
RigidMotion liftRotation(const Sternum& sternum, Vec3 deepest, double lift, Pivot pivot, double pivotDistance);

/// Cartilages at `count` >= 2 equal steps of the motion.
std::vector<std::vector<MovedCartilage>> motionFrames(const RibCage& cage, const RigidMotion& motion, int count);

/// Number of the rib above the intercostal space at height z beside the sternum, from where the cartilages join it and the ribs
/// end; 0 if none is known.
int intercostalSpace(const RibCage& cage, double z);

}  // namespace pectora
