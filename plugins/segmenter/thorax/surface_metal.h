// Metal on the skin: wires of a brassiere, clips, electrodes.
#pragma once

#include "plugins/segmenter/thorax/field.h"

namespace pectora::thorax {

/// Replaces by air what lies on the body and is brighter than 200 HU: pieces of at most 200 mm^2 in the slice, grown by one pixel, that
/// come within 3 mm of the air outside and are brighter than 500 HU somewhere; no bone lies so shallow, and noise is not so bright.
/// `plane` is a slice of the CT, in HU, with air around the body; outside is what is darker than `levelHu` and reaches the plane's
/// border.
void removeSurfaceMetal(Plane& plane, Vec3 spacing, float levelHu);

}  // namespace pectora::thorax
