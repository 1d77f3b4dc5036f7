// The undeformed torso: the surfaces that rib cage, inner wall and skin form, fitted to the skeleton.
#pragma once

#include "polar_table.h"
#include "skeleton.h"

namespace pectora::phantom {

/// Surfaces of the undeformed, unscaled body. Distances are signed mm along the normal (first order), positive
/// outside.
struct Torso {
  Skeleton skeleton;
  PolarTable wall;    ///< mid-surface of ribs, cartilages and sternum; abdominal wall and neck muscles beyond
  PolarTable inner;   ///< pleura: inner rib surface + 1.5 mm; the abdominal wall's inside below the diaphragm
  PolarTable muscle;  ///< outside of the muscles (or of the sternum)
  PolarTable skin;    ///< outside of the skin
};

/// Builds the torso. `depthScale` scales the ribs' depth (the chest's flatness), `bmi` the fat by (bmi / 20)^2.
Torso buildTorso(double depthScale, double bmi);

constexpr double kSkinThickness = 1.8;  ///< mm

}  // namespace pectora::phantom
