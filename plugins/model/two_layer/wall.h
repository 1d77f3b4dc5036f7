// The wall of two layers, whatever effects act on it.
#pragma once

#include "plugins/model/common/layers.h"

#include <functional>

namespace pectora {

struct WallSettings {
  LayerSettings layers;
  double reach = 40;       ///< as findAnchors, mm
  double density = 1060;   ///< as weighLayers, kg/m3

  bool operator==(const WallSettings&) const = default;
};

/// A scene without effects. The last one is remembered, as a slider of an effect asks for the same wall again and again. `attaching` is called
/// before the longer half of the work, and may throw to stop it. Throws Error as buildLayers does.
std::shared_ptr<const Scene> wallOf(std::shared_ptr<const RibCage> cage, const WallSettings& settings, const std::function<void()>& attaching);

}  // namespace pectora
