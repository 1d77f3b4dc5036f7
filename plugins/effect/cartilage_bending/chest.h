// What the costal cartilages do against the lift.
#pragma once

#include "kernel/value/plan.h"

namespace pectora {

/// What the chest does against the whole plan, N mm: the sum of k d^2. Each cartilage is a beam that is clamped at its rib and
/// guided at its medial end, k = 12 E I / L^3 of its length at rest, in series with its rib; d is the way of that end. As the plan
/// leaves the ribs where they are, the short cartilages 1 to 3 make up two thirds of it, and forces come out at two to three times
/// the 108 to 175 N that were measured in patients. `youngsModulus` in N/mm^2, `secondMoment` I in mm^4, `ribStiffness` of a rib's
/// front end in N/mm.
double chestResistance(const Plan& plan, double youngsModulus, double secondMoment, double ribStiffness);

/// I of an ellipse about the axis across `depth`, mm^4.
double secondMomentOfEllipse(double height, double depth);

}  // namespace pectora
