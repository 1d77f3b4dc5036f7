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

/// The deepest point of the pit on the front of the sternum: at the level in the body's caudal half where the sternum lies farthest
/// behind the most forward inner wall. The lower sternum runs forwards, so that its most posterior point lies above
/// that level; it is taken where no level was measured.
Vec3 deepestOfPit(const Anatomy& anatomy);

/// The point of the sternum's front at height z, as near to `x` as its contour there goes; an infinite y if the nearest contour
/// is farther than 10 mm from z.
Vec3 frontOfSternum(const Sternum& sternum, double x, double z);

/// Cartilages at `count` >= 2 equal steps of the motion.
std::vector<std::vector<MovedCartilage>> motionFrames(const RibCage& cage, const RigidMotion& motion, int count);

/// Number of the rib above the intercostal space at height z beside the sternum, from where the cartilages join it and the ribs
/// end; 0 if none is known.
int intercostalSpace(const RibCage& cage, double z);

}  // namespace pectora
