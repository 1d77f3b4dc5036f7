#include "kernel/stage/wall_effect.h"

#include "kernel/stage/layer_effect.h"

#include <fmt/format.h>

namespace pectora {

std::string WallSprings::emptyBecause(const Scene& scene) {
  return !scene.cellTissue.empty() && calls(scene, "effect.tissue") ? "the wall is a solid: effect.tissue stands for it" : "";
}

CrossStiffness WallSprings::calibrate(const Scene& scene, std::vector<std::string>& notes) const {
  const CrossStiffness cross = calibrateCross(1.25e-3 * youngsModulus / (1 + poissonsRatio), scene.rowSpacing, scene.columnSpacing, scene.thickness);
  if (!cross.isFeasible)
    notes.push_back(fmt::format("the wall of {:.1f} mm is too thick for a spacing of {:.1f} x {:.1f} mm: its shear is too soft; "
                                "a spacing of {:.0f} mm would be right",
                                scene.thickness, scene.rowSpacing, scene.columnSpacing, scene.thickness / 2.45));
  return cross;
}

}  // namespace pectora
