// What the operation does to the indices that pectus excavatum is judged by.
#pragma once

#include "kernel/value/plan.h"

#include <functional>
#include <optional>

namespace pectora {

/// The levels of least sternum-to-vertebra distance in the caudal half of the sternal body before and after the plan.
struct PlannedIndices {
  LevelMetrics before, after;
};

/// Every level after the plan, caudal first; what the plan does not change is as it was, and the skin's lengths are left out.
/// Every level's B grows by as much as the plan brings the back of the sternum forward there. The inner width T and the
/// ribs' most anterior inner wall stay, as the planner moves no rib; a sternum that comes to lie before that wall becomes
/// the wall: C = max(C, B), and so on the side where it lies. Levels that the sternum leaves are left out.
std::vector<LevelMetrics> plannedLevels(const Anatomy& anatomy, const RigidMotion& sternum);

/// The two chosen levels. Nothing if the anatomy has no such level, or the sternum leaves them all.
std::optional<PlannedIndices> plannedIndices(const Anatomy& anatomy, const RigidMotion& sternum);

/// The same levels with the lengths of a skin that was found in another way (predicted, or scanned after the operation): width and
/// back are those of `anatomy` at that level, the front is `frontOf(z, front of the vertebra, half the width)`.
std::vector<LevelMetrics> withSkin(std::vector<LevelMetrics> levels, const Anatomy& anatomy,
                                   const std::function<std::vector<Vec3>(double, Vec3, double)>& frontOf);

}  // namespace pectora
