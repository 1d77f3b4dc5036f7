// The pictures of the README: the real panels, worked by a hand.
#pragma once

#include "app/view/view.h"

namespace pectora::view {

/// Makes a phantom, goes through the steps, and writes a picture of each into options.tour: bar.png, tissue.png, anatomy.png ...
void takeTour(Registry& registry, const ViewOptions& options);

}  // namespace pectora::view
