// The pictures of the README: the real panels, worked by a hand.
#pragma once

#include "app/view/view.h"

namespace pectora::view {

/// Makes a phantom, goes through the steps, and writes bar.png, tissue.png, anatomy.png and compare.png into options.tour.
void takeTour(Registry& registry, const ViewOptions& options);

}  // namespace pectora::view
