#include "plugins/planner/nuss/motion.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pectora {

RigidMotion liftRotation(const Sternum& sternum, Vec3 deepest, double lift, Pivot pivot, double pivotDistance) {
  RigidMotion motion;
  motion.pivot = pivot == Pivot::manubrium
                     ? sternum.manubriosternalJoint
                     : Vec3{deepest.x, sternum.manubriosternalJoint.y, deepest.z + pivotDistance};
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

std::vector<std::vector<MovedCartilage>> motionFrames(const RibCage& cage, const RigidMotion& motion, int count) {
  std::vector<std::vector<MovedCartilage>> frames;
  for (int f = 0; f < count; ++f) frames.push_back(followSternum(cage, motion.part(double(f) / (count - 1))));
  return frames;
}

int intercostalSpace(const RibCage& cage, double z) {
  // The lowest rib whose cartilage joins the sternum above z.
  int space = 0;
  for (const Notch& notch : cage.anatomy->sternum.notches)
    if (notch.position.z >= z) space = std::max(space, notch.rib);
  return space;
}

}  // namespace pectora
