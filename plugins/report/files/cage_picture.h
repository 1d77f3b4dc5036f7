// The rib cage in front and side view.
#pragma once

#include "plugins/report/files/canvas.h"

#include "kernel/value/plan.h"

namespace pectora {

/// Ribs (numbered), cartilages, sternum and, with a plan, the moved cartilages and sternum and the bar.
Canvas cagePicture(const RibCage& cage, const Plan* plan);

}  // namespace pectora
