// What the effects of springs between skin and pleura have in common.
#pragma once

#include "kernel/physics/calibration.h"
#include "kernel/stage/effect.h"

namespace pectora {

/// Settings of the springs through the chest wall, and the constants that follow from them.
struct WallSprings {
  double youngsModulus = 10;   ///< kPa, of fat and muscle together
  double poissonsRatio = 0.25; ///< of the tissue; what springs alone have
  double stiffness = 0;        ///< N/mm, 0: calibrate
  double reach = 0;            ///< mm; 0: two rows and columns

  void describe(Visitor& v) {
    v.real("youngs_modulus", youngsModulus, "kPa", {1e-6, 1e9}, {1, 100}, "Young's modulus of the tissue between skin and pleura, from which the spring constants follow");
    v.real("poissons_ratio", poissonsRatio, "", {0.25, 0.4999}, {0.25, 0.49}, "Poisson's ratio of the tissue: springs alone have 1/4; above it they leave the rest to effect.volume, called with the same");
    v.real("stiffness", stiffness, "N/mm", {0, 1e12}, {0, 1}, "Spring constant given by hand; 0: from Young's modulus");
    v.real("reach", reach, "mm", {0, 1000}, {0, 40}, "How far oblique springs reach along rows and columns, the same for effect.direct and effect.cross: in mm the wall stays the same wall when its spacing is refined; 0: two rows and columns, as in the paper");
  }
  /// Why springs through the wall have no place in a scene; empty if they have.
  static std::string emptyBecause(const Scene& scene);
  /// The calibrated constants, N/mm; a note where the wall is too thick for the spacing. Springs made for E_s have the shear
  /// modulus E_s / 2.5, so they aim at E_s = 2.5 mu = 1.25 E / (1 + nu).
  CrossStiffness calibrate(const Scene& scene, std::vector<std::string>& notes) const;
};

}  // namespace pectora
