// Makes a volume of a scan with a tilted gantry rectangular.
#pragma once

#include "kernel/value/volume.h"

namespace pectora::dicom {

/// Voxel (i, j, k) of `sheared` lies at (i + k * driftX, j + k * driftY, k) of its grid, in voxels. Returns the volume on a
/// rectangular grid that is large enough for all slices: each is shifted within its plane by linear interpolation. What
/// no slice covers is -1024 HU.
Volume untilt(const Volume& sheared, double driftX, double driftY);

}  // namespace pectora::dicom
