// Axial slices with what the segmenter found drawn over them.
#pragma once

#include "plugins/report/files/canvas.h"

#include "kernel/value/anatomy.h"
#include "kernel/value/volume.h"

namespace pectora {

/// Slice k of the CT (window 400 HU around 40) with the contours of that slice in colours, rib numbers, and a legend.
Canvas slicePicture(const Volume& ct, const Anatomy& anatomy, int slice);

}  // namespace pectora
