#include "plugins/planner/nuss/motion.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pectora {

Vec3 pivotPoint(const Sternum& sternum, Vec3 lifted, Pivot pivot, double pivotDistance) {
  if (pivot == Pivot::manubrium) return sternum.manubriosternalJoint;
  return {lifted.x, sternum.manubriosternalJoint.y, lifted.z + pivotDistance};
}

RigidMotion liftRotation(Vec3 deepest, double lift, Vec3 pivot) {
  RigidMotion motion;
  motion.pivot = pivot;
  // About +x, the point r = (y, z) from the axis goes to y cos a - z sin a: forward (y falls) for the negative z below
  // the axis needs a negative angle. The rise a -> y - y(a) grows up to where r points straight forward.
  const double ry = deepest.y - motion.pivot.y, rz = deepest.z - motion.pivot.z;
  if (rz > -20)
    throw Error("the deepest point of the sternum is not below the axis that the sternum turns about")
        .of("pivot").given(fmt::format("{:.0f} mm below", -rz)).allowed("20 mm or more").advise("Choose the sternoclavicular pivot, or a larger pivot_distance");
  const auto rise = [&](double angle) { return ry - (ry * std::cos(angle) - rz * std::sin(angle)); };
  double low = 0, high = -std::numbers::pi / 3;
  if (rise(high) < lift)
    throw Error("no rotation of the sternum below 60 degrees lifts so far")
        .of("lift").given(fmt::format("{:.1f} mm", lift)).allowed(fmt::format("up to {:.1f} mm", rise(high))).advise("Lift less, or choose a pivot further away");
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (rise(middle) < lift ? low : high) = middle;
  }
  motion.axis = {1, 0, 0};
  motion.angle = lift == 0 ? 0 : 0.5 * (low + high);
  return motion;
}

RigidMotion liftBoth(const LiftedPoint& first, const LiftedPoint& second, Vec3 axis, double leastDistance) {
  const Vec3 a = first.point - axis, b = second.point - axis;
  if (std::abs(a.z - b.z) < leastDistance)
    throw Error("the two bars lie on each other")
        .of("second_level").given(fmt::format("{:.1f} mm from the first bar", std::abs(a.z - b.z))).allowed(fmt::format("{:.1f} mm or more, the bar's width", leastDistance))
        .advise("Bring the bars further apart, or set second_level to 0 for one bar");
  // Turned by t about x, the depth between the points is dy cos t - dz sin t = R cos(t + phi), which must lose first.lift - second.lift.
  const double dy = a.y - b.y, dz = a.z - b.z, length = std::hypot(dy, dz), phi = std::atan2(dz, dy);
  const double wanted = (dy - (first.lift - second.lift)) / length;
  RigidMotion motion;
  motion.pivot = axis;
  motion.angle = std::abs(wanted) <= 1 ? std::copysign(std::acos(wanted), phi) - phi : INFINITY;
  if (!(std::abs(motion.angle) <= std::numbers::pi / 3))
    throw Error("no rotation of the sternum below 60 degrees brings both points to their lifts")
        .of("second_lift").given(fmt::format("{:.1f} mm beside {:.1f} mm, {:.0f} mm apart", second.lift, first.lift, std::abs(dz)))
        .advise("Bring the two lifts closer to each other, or the bars further apart");
  motion.translation.y = -first.lift - (motion(first.point).y - first.point.y);
  return motion;
}

Vec3 frontOfSternum(const Sternum& sternum, double x, double z) {
  const std::vector<Vec3>* nearest = nullptr;
  for (const auto& contour : sternum.contours)
    if (!contour.empty() && (!nearest || std::abs(contour.front().z - z) < std::abs(nearest->front().z - z))) nearest = &contour;
  if (!nearest || std::abs(nearest->front().z - z) > 10) return {x, INFINITY, z};
  // Of the points about as near to x as any, the most forward one.
  double closest = INFINITY;
  for (const Vec3& p : *nearest) closest = std::min(closest, std::abs(p.x - x));
  Vec3 front{x, INFINITY, z};
  for (const Vec3& p : *nearest)
    if (std::abs(p.x - x) <= closest + 3 && p.y < front.y) front = p;
  return front;
}

Vec3 deepestOfPit(const Anatomy& anatomy) {
  const Sternum& sternum = anatomy.sternum;
  const double middle = 0.5 * (sternum.manubriosternalJoint.z + sternum.xiphisternalJoint.z);
  const LevelMetrics* deepest = nullptr;
  for (const LevelMetrics& level : anatomy.metrics)
    if (level.z <= middle && level.z >= sternum.xiphisternalJoint.z && (!deepest || level.depression() > deepest->depression())) deepest = &level;
  if (!deepest) return sternum.deepest;
  const Vec3 front = frontOfSternum(sternum, sternum.deepest.x, deepest->z);
  return std::isfinite(front.y) ? front : sternum.deepest;
}

std::vector<std::vector<MovedCartilage>> motionFrames(const RibCage& cage, const RigidMotion& motion, int count) {
  std::vector<std::vector<MovedCartilage>> frames(static_cast<std::size_t>(count));
  parallelFor(frames.size(), [&](std::size_t f) { frames[f] = followSternum(cage, motion.part(double(f) / (count - 1))); });
  return frames;
}

}  // namespace pectora
