// The frame in which the segmenter works: mm along the rows, columns and slices of an upright CT.
#pragma once

#include "kernel/value/volume.h"

#include <memory>

namespace pectora::thorax {

/// The same CT with its axes permuted and flipped so that axis 0 runs most nearly to the patient's left, axis 1 to the
/// back and axis 2 to the head. No voxel is interpolated; a CT that is upright already is returned as it is.
std::shared_ptr<const Volume> upright(std::shared_ptr<const Volume> ct);

/// Local mm (voxel index times spacing) to LPS mm.
inline Vec3 toPatient(const Grid& grid, Vec3 local) {
  return grid.toPatient({local.x / grid.spacing.x, local.y / grid.spacing.y, local.z / grid.spacing.z});
}
/// LPS mm to local mm.
inline Vec3 toLocal(const Grid& grid, Vec3 patient) {
  const Vec3 voxel = grid.toVoxel(patient);
  return {voxel.x * grid.spacing.x, voxel.y * grid.spacing.y, voxel.z * grid.spacing.z};
}

}  // namespace pectora::thorax
