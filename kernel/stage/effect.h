// The interface of an effect plugin: it turns a scene into springs or into energy terms of its own.
#pragma once

#include "kernel/physics/springs.h"
#include "kernel/stage/plugin.h"
#include "kernel/value/plan.h"

namespace pectora {

/// What an effect changes in how the plan moves the bodies. Called with each plan; what is not set changes nothing.
struct Steering {
  /// The bars and the chest share the plan's way as springs in series. What each would do against it, N mm: the sum over what gives
  /// way of stiffness times the square of its way in the whole plan.
  std::function<double(const Plan&)> barResistance, chestResistance;
  /// How far an anchor goes beside its way in the plan, mm, in equal parts from the beginning to the end.
  std::function<Vec3(const Plan&, const Anchor&)> displacement;
  /// Where the effect's guides lie after part t of the plan; `anchors`: where the scene's then are, with what all effects add to their way.
  std::function<std::vector<Vec3>(const Plan&, double t, const std::vector<Vec3>& anchors)> guides;
};

/// What an effect adds to the problem. Springs are data, and all effects' stencils are fused into one term.
struct Contribution {
  std::vector<StencilSpring> stencil;
  std::vector<NodeSpring> springs;
  std::vector<std::unique_ptr<Term>> terms;
  /// Makes a load that the CT shows the chest under, times a factor; called while contribute's arguments live. The scene's
  /// shape is then at rest under it, and the shape without it is found before `terms` act.
  std::function<std::unique_ptr<Term>(double factor)> loadInCt;
  /// Driven nodes of its own, as long as no plan is known; they are numbered from system.rest.size() on.
  std::vector<Vec3> guides;
  Steering steering;
  /// What it asks for of a motion in time; without a duration nothing moves in time. The longest times and the sum of the dampings of
  /// all effects count.
  Dynamics dynamics;
  std::string emptyBecause;             ///< why it adds nothing to this scene; it then drops out
  std::vector<std::string> notes;       ///< what was computed on the way, such as a calibrated spring constant
};

class Effect {
 public:
  virtual ~Effect() = default;
  virtual void describe(Visitor& visitor) = 0;
  /// `system` has its nodes and masses, but no terms yet; System::node and anchorNode number the scene's points and anchors.
  /// What it returns refers to neither.
  virtual Contribution contribute(const Scene& scene, const System& system) = 0;
};

}  // namespace pectora
