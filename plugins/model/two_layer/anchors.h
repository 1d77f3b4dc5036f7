// Where the pleura hangs on the rib cage.
#pragma once

#include "kernel/value/scene.h"

namespace pectora {

/// The closest points on the three closest different bodies (a rib, a cartilage or the sternum each) for every inner point;
/// fewer where the cage has fewer bodies. Ordered by inner point.
std::vector<Anchor> findAnchors(const Scene& scene);

}  // namespace pectora
