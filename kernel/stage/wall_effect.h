// What the effects of springs between skin and pleura have in common.
#pragma once

#include "kernel/physics/calibration.h"
#include "kernel/stage/effect.h"

namespace pectora {

/// Settings of the springs through the chest wall, and the constants that follow from them.
struct WallSprings {
  double youngsModulus = 10;   ///< kPa, of fat and muscle together
  double stiffness = 0;        ///< N/mm, 0: calibrate

  void describe(Visitor& v) {
    v.real("youngs_modulus", youngsModulus, "kPa", {1e-6, 1e9}, {1, 100}, "Young's modulus of the tissue between skin and pleura, from which the spring constants follow");
    v.real("stiffness", stiffness, "N/mm", {0, 1e12}, {0, 1}, "Spring constant given by hand; 0: from Young's modulus");
  }
  /// The calibrated constants, N/mm; a note where the wall is too thick for the spacing.
  CrossStiffness calibrate(const Scene& scene, std::vector<std::string>& notes) const;
};

}  // namespace pectora
