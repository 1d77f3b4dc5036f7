// The rib cage in front and side view.
#pragma once

#include "plugins/report/files/canvas.h"

#include "kernel/value/plan.h"

namespace pectora {

/// Ribs (numbered), cartilages and sternum as solids; with a plan cartilages and sternum as they come to lie, with the bar, and as
/// lines where they were.
Canvas cagePicture(const RibCage& cage, const Plan* plan);

}  // namespace pectora
