// Axial slices with what the segmenter found drawn over them.
#pragma once

#include "plugins/report/files/canvas.h"

#include "kernel/value/rib_cage.h"
#include "kernel/value/volume.h"

namespace pectora {

/// Slice k of the CT (window 400 HU around 40) with the contours of that slice in colours, rib numbers, a ring where a costal cartilage
/// of the cage (may be null) passes through it, and a legend.
Canvas slicePicture(const Volume& ct, const Anatomy& anatomy, const RibCage* cage, int slice);

}  // namespace pectora
