// Where two surfaces differ.
#pragma once

#include "plugins/common/surface/surface_tree.h"

namespace pectora {

/// Which points lie further than `threshold` from another surface, and what is within `margin` of those. `found` are their closest points
/// there. Lengths in mm. Points that face the other surface's border count as unchanged.
std::vector<bool> changedPoints(const std::vector<Vec3>& points, const std::vector<SurfaceHit>& found, double threshold, double margin);

/// The marked points, and those within `margin` (mm) of one.
std::vector<bool> withMargin(const std::vector<Vec3>& points, std::vector<bool> isMarked, double margin);

}  // namespace pectora
