// What the operation does to the indices that pectus excavatum is judged by.
#pragma once

#include "kernel/value/plan.h"

#include <optional>

namespace pectora {

/// The levels of least sternum-to-vertebra distance in the caudal half of the sternal body before and after the plan.
struct PlannedIndices {
  LevelMetrics before, after;
};

/// Every level's B grows by as much as the plan brings the back of the sternum forward there. The inner width T and the
/// ribs' most anterior inner wall stay, as the planner moves no rib; a sternum that comes to lie before that wall becomes
/// the wall: C = max(C, B). Nothing if the anatomy has no such level, or the sternum leaves them all.
std::optional<PlannedIndices> plannedIndices(const Anatomy& anatomy, const RigidMotion& sternum);

}  // namespace pectora
