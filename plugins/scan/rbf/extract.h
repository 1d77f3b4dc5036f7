// The zero surface of a field, followed from cell to cell.
#pragma once

#include "kernel/value/mesh.h"

#include <functional>

namespace pectora {

struct ExtractSettings {
  double cell = 2;     ///< side of the grid's cells, mm
  double reach = 10;   ///< how far from the seeds the surface is followed, mm
};

/// Triangles of the zero surface by marching tetrahedra (six a cell, so that neighbours fit), with normals towards positive values.
/// It starts at the cells of the seeds and goes on through every face that it crosses, as long as `distance` (to the nearest seed, mm) is
/// within reach. `field` gives mm or NaN (no surface there); both functions are called from several threads.
Mesh extractSurface(const std::vector<Vec3>& seeds, const std::function<double(Vec3)>& field, const std::function<double(Vec3)>& distance,
                    const ExtractSettings& settings, const std::function<void(double)>& poll);

}  // namespace pectora
