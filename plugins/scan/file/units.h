// Files of points do not say their unit: it is given, or plausible, or asked for; never guessed silently.
#pragma once

#include "kernel/value/vec3.h"

#include <span>
#include <string>

namespace pectora {

/// mm in one unit of the file. `units` is "mm", "cm", "m", "inch", or "" for not given: then millimetres are assumed where the
/// largest extent would be that of a torso (100 to 2500 mm), else an Error says how large it would be in each unit.
double millimetresPerUnit(const std::string& units, std::span<const Vec3> points);

}  // namespace pectora
