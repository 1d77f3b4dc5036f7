// Turns a scene and a plan into the problem that solvers solve.
#pragma once

#include "kernel/host/registry.h"
#include "kernel/stage/effect.h"

#include <cmath>

namespace pectora {

/// What became of one effect that a scene called.
struct EffectUse {
  std::string id = {};
  bool isActive = true;
  std::string reason = {};               ///< why it dropped out
  std::size_t springs = 0;          ///< pairs of points that it joins
  std::vector<std::string> notes = {};   ///< such as calibrated constants
  bool hasHessian = true;           ///< whether all its terms offer one
  bool hasSprings = true;           ///< whether it is nothing but springs
  bool movesInTime = false;         ///< whether it asks for a motion in time, in place of its end at rest
  double changeRms = NAN, changeMax = NAN;   ///< mm of the skin, as probed by leaving it out; only `explain` asks
  std::string notProbed = {};            ///< why there is no such figure
};

struct Compiled {
  std::unique_ptr<System> system;
  std::vector<EffectUse> effects;
  bool isLoadedInCt = false;   ///< an effect has loads that the CT shows the chest under
  struct Guided {
    Steering steering;
    std::size_t guides = 0;    ///< how many driven nodes are its own; they follow the anchors in this order
  };
  std::vector<Guided> steering;
};

/// What becomes of the loads that the CT shows the chest under.
enum class CtLoads {
  off,        ///< the chest is free of them: only those after the operation act, on a scene that is the shape without load
  alone,      ///< only they act
  countered,  ///< those after the operation act, less those of the CT: right to first order on the scene as the CT shows it
};

/// Opens the effects that the scene calls, and no others, and builds their terms; all stencils share one term.
/// Throws Error if a stiffness or mass is not positive and finite, or a point is held by nothing.
Compiled compile(const Scene& scene, Registry& registry, CtLoads loads = CtLoads::off);

/// How the bars and the chest share the way.
struct BarLoad {
  double part = 1;       ///< of the planned way that the sternum goes
  std::vector<double> forces = {};   ///< of the chest on each bar, N, in proportion to their lifts; empty if no effect knows the chest's stiffness
};
BarLoad shareLift(const Compiled& compiled, const Plan& plan);

/// Where the driven nodes go while the plan is carried out.
Drive makeDrive(const Scene& scene, const Compiled& compiled, const Plan& plan);
/// The same on the straight way from rest to the end of the plan, which costs less: for a solve that begins where an earlier one ended.
Drive makeDriveEnd(const Scene& scene, const Compiled& compiled, const Plan& plan);

}  // namespace pectora
