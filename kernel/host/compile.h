// Turns a scene and a plan into the problem that solvers solve.
#pragma once

#include "kernel/host/registry.h"
#include "kernel/physics/system.h"
#include "kernel/value/plan.h"

#include <cmath>

namespace pectora {

/// What became of one effect that a scene called.
struct EffectUse {
  std::string id;
  bool isActive = true;
  std::string reason;               ///< why it dropped out
  std::size_t springs = 0;          ///< pairs of points that it joins
  std::vector<std::string> notes;   ///< such as calibrated constants
  bool hasHessian = true;           ///< whether all its terms offer one
  bool hasSprings = true;           ///< whether it is nothing but springs
  double changeRms = NAN, changeMax = NAN;   ///< mm of the skin, as probed by leaving it out; only `explain` asks
  std::string notProbed;            ///< why there is no such figure
};

struct Compiled {
  std::unique_ptr<System> system;
  std::vector<EffectUse> effects;
};

/// Opens the effects that the scene calls, and no others, and builds their terms; all stencils share one term.
/// Throws Error if a stiffness or mass is not positive and finite, or a point is held by nothing.
Compiled compile(const Scene& scene, Registry& registry);

/// Where the anchors go while the plan is carried out.
Drive makeDrive(const Scene& scene, const Plan& plan);

}  // namespace pectora
