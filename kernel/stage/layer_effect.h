// What the effects of springs between skin points have in common: their settings and the calibrated sheet.
#pragma once

#include "kernel/physics/calibration.h"
#include "kernel/stage/effect.h"

namespace pectora {

/// Part of the skin's stiffness that bend springs carry where a scene calls effect.bend.
inline constexpr double kBendShare = 0.2;

/// Settings of one kind of spring within the skin, and the constants that follow from them.
struct SkinSprings {
  double youngsModulus = 100;   ///< kPa
  double skinThickness = 1.8;   ///< mm
  double stiffness = 0;         ///< N/mm, 0: calibrate
  double compression = 1;       ///< part of the stiffness under compression

  void describe(Visitor& v) {
    v.real("youngs_modulus", youngsModulus, "kPa", {1e-6, 1e9}, {20, 2000}, "Young's modulus of the skin, from which the spring constant follows");
    v.real("skin_thickness", skinThickness, "mm", {1e-3, 20}, {0.5, 4}, "Thickness of the skin");
    v.real("stiffness", stiffness, "N/mm", {0, 1e12}, {0, 10}, "Spring constant given by hand; 0: from Young's modulus");
    v.real("compression", compression, "", {0, 1}, {0, 1}, "Part of the stiffness that acts while a spring is shorter than at rest: slack skin folds instead of pushing; 1: the paper's springs");
  }
  LayerStiffness calibrate(const Scene& scene) const;
};

/// Whether a scene calls an effect.
bool calls(const Scene& scene, const std::string& id);

}  // namespace pectora
