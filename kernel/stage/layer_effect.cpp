#include "kernel/stage/layer_effect.h"

#include <algorithm>

namespace pectora {

LayerStiffness SkinSprings::calibrate(const Scene& scene) const {
  const double e2 = youngsModulus * 1e-3 * skinThickness;  // kPa mm -> N/mm
  return calibrateLayer(e2, scene.rowSpacing, scene.columnSpacing, calls(scene, "effect.bend") ? kBendShare : 0);
}

bool calls(const Scene& scene, const std::string& id) {
  return std::any_of(scene.effects.begin(), scene.effects.end(), [&](const auto& call) { return call->id == id; });
}

}  // namespace pectora
