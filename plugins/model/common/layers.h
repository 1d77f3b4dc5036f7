// The grids of skin and pleura points.
#pragma once

#include "kernel/stage/parameters.h"
#include "kernel/value/scene.h"

namespace pectora {

struct LayerSettings {
  double spacing = 10;       ///< wanted distance between neighbours on the skin, mm, along rows and columns
  double margin = 20;        ///< how far the model reaches above and below the ribs and sternum, mm
  double still = 0;          ///< Scene::still
  double accuracy = 0;       ///< Scene::effectAccuracy

  void describe(Visitor& v);
};

/// Fills rows, columns, outer, inner and spacings of `scene` from the layers of scene.cage->anatomy: rows at equal
/// levels within the longest run of unclipped skin, skin points at equal arc length on each, pleura points where a ray
/// through the skin point, straight forwards over the front and fanning out at the sides, leaves the pleura.
/// Throws Error if the anatomy has too little of the layers.
void buildLayers(const LayerSettings& settings, Scene& scene);

}  // namespace pectora
