// Where the fronts of the bars are while they are turned into place.
#pragma once

#include "kernel/value/plan.h"

namespace pectora {

/// A place no bar reaches, behind a point: where the front of the bar is for a point that has none behind it.
inline Vec3 farBehind(Vec3 point) { return point + Vec3{0, 1e4, 0}; }

/// For each point at rest, where a bar's front lies behind or in front of it after part t of the plan: of the bar's middle part
/// that runs inside the chest, which is where it lies behind the ends of its hinges; farBehind beside it. A bar comes
/// forward with its lift. `margin` is added to half the bar's width, mm.
std::vector<Vec3> barFront(const Plan& plan, double t, const std::vector<Vec3>& points, double margin);

}  // namespace pectora
