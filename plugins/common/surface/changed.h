// Where two surfaces differ.
#pragma once

#include "plugins/common/surface/surface_tree.h"

namespace pectora {

/// Which points of `mesh` lie further than `threshold` from the other surface, and what is within `margin` of those. Lengths in mm.
/// Points that face the other surface's border count as unchanged. `poll` is called now and then with the fraction done, and may throw.
std::vector<bool> changedPoints(const Mesh& mesh, const SurfaceTree& other, double threshold, double margin,
                                const std::function<void(double)>& poll);

}  // namespace pectora
