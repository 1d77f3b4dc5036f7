#include "kernel/stage/wall_effect.h"

#include "kernel/stage/layer_effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {

std::string WallSprings::emptyBecause(const Scene& scene) {
  return !scene.cellTissue.empty() && calls(scene, "effect.tissue") ? "the wall is a solid: effect.tissue stands for it" : "";
}

CrossStiffness WallSprings::calibrate(const Scene& scene, std::vector<std::string>& notes) const {
  const auto steps = [&](double spacing) { return reach > 0 ? std::max(1, int(std::lround(reach / spacing))) : 2; };
  const CrossStiffness cross = calibrateCross(1.25e-3 * youngsModulus / (1 + poissonsRatio), scene.rowSpacing, scene.columnSpacing, scene.thickness,
                                              steps(scene.rowSpacing), steps(scene.columnSpacing));
  if (!cross.isFeasible)
    notes.push_back(fmt::format("the wall of {:.1f} mm is too thick for springs that reach {} x {} points {:.1f} x {:.1f} mm apart: its shear is too soft, and "
                                "softer with finer spacing; reach = {:.0f} (mm), a spacing of {:.0f} mm, or model.volume_mesh would be right",
                                scene.thickness, cross.rows, cross.columns, scene.rowSpacing, scene.columnSpacing, scene.thickness, scene.thickness / 2.45));
  return cross;
}

}  // namespace pectora
