// How far a scan lies from each point of the predicted skin.
#pragma once

#include "kernel/value/comparison.h"

namespace pectora::view {

/// How far the scan lies outside each point of the skin that it was compared with, mm, NaN where it has no counterpart. Of a mesh as the
/// comparison measured it; of a cloud the distance of the nearest point that has a counterpart itself, if that is no more than 5 mm aside.
std::vector<double> scanDistances(const Comparison& comparison, const std::vector<Vec3>& skin);

}  // namespace pectora::view
