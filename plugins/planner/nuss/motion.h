// How the bar turns the sternum.
#pragma once

#include "kernel/value/plan.h"

#include <string>

namespace pectora {

enum class Pivot {
  sternoclavicular,   ///< an axis above the sternum: fits measured elevations (38.6, 28.4, 19.4 mm at 0, 4, 8 cm)
  manubrium,          ///< the manubriosternal joint, as in Moreira et al. 2012
};

/// A point of the transverse axis that one bar turns the sternum about. `pivotDistance` is how far the sternoclavicular axis lies
/// above the lifted point, mm; the manubrial axis runs through the sternum's joint.
Vec3 pivotPoint(const Sternum& sternum, Vec3 lifted, Pivot pivot, double pivotDistance);

/// The rotation about the transverse axis through `pivot` that brings `deepest` forward by `lift` mm (y falls by it). Throws Error if
/// no rotation below 60 degrees lifts so far.
RigidMotion liftRotation(Vec3 deepest, double lift, Vec3 pivot);

/// A point of the sternum's front, and how far it is to come forward, mm (y falls by it).
struct LiftedPoint {
  Vec3 point;
  double lift = 0;
};

/// The motion in the sagittal plane that brings both points forward by their lifts. `axis` is a point of the axis that one bar alone
/// would turn the sternum about: it keeps its height, so that two lifts that such a turn brings about give that very turn.
/// Throws Error if the points lie less than `leastDistance` mm above each other, or no turn below 60 degrees makes the
/// difference of the lifts.
RigidMotion liftBoth(const LiftedPoint& first, const LiftedPoint& second, Vec3 axis, double leastDistance);

/// The deepest point of the pit on the front of the sternum: at the level in the body's caudal half where the sternum lies farthest
/// behind the most forward inner wall. The lower sternum runs forwards, so that its most posterior point lies above
/// that level; it is taken where no level was measured.
Vec3 deepestOfPit(const Anatomy& anatomy);

/// The point of the sternum's front at height z, as near to `x` as its contour there goes; an infinite y if the nearest contour
/// is farther than 10 mm from z.
Vec3 frontOfSternum(const Sternum& sternum, double x, double z);

/// Cartilages at `count` >= 2 equal steps of the motion.
std::vector<std::vector<MovedCartilage>> motionFrames(const RibCage& cage, const RigidMotion& motion, int count);

}  // namespace pectora
