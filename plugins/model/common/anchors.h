// Where the pleura hangs on the rib cage.
#pragma once

#include "kernel/value/scene.h"

namespace pectora {

/// The closest points on the three closest different bodies (a rib, a cartilage or the sternum each) for every inner point;
/// fewer where the cage has fewer bodies. A point further than `reach` mm from every body lies on the abdomen, which the
/// operation does not move: it is held where it is. A body within 5 mm
/// holds the point itself: it moves with the body by a spring of no length. Ordered by inner point; then one for each skin point on the edge of
/// the grid, where the skin goes on beyond the model.
std::vector<Anchor> findAnchors(const Scene& scene, double reach);

}  // namespace pectora
