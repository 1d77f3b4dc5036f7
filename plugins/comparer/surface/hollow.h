// Where a chest is hollow, told from the chest alone.
#pragma once

#include "kernel/value/mesh.h"

namespace pectora {

/// For every point of a skin, how far it lies behind a string that is stretched over the front of its axial slice (the convex hull of
/// the slice, seen from -y), mm; 0 for points that do not face forwards. Coordinates are LPS, indices good, points finite.
std::vector<double> hollowDepths(const Mesh& skin);

}  // namespace pectora
