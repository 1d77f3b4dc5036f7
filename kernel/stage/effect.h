// The interface of an effect plugin: it turns a scene into springs or into energy terms of its own.
#pragma once

#include "kernel/physics/springs.h"
#include "kernel/stage/plugin.h"
#include "kernel/value/scene.h"

namespace pectora {

/// What an effect adds to the problem. Springs are data, and all effects' stencils are fused into one term.
struct Contribution {
  std::vector<StencilSpring> stencil;
  std::vector<NodeSpring> springs;
  std::vector<std::unique_ptr<Term>> terms;
  std::string emptyBecause;             ///< why it adds nothing to this scene; it then drops out
  std::vector<std::string> notes;       ///< what was computed on the way, such as a calibrated spring constant
};

class Effect {
 public:
  virtual ~Effect() = default;
  virtual void describe(Visitor& visitor) = 0;
  /// `system` has its nodes and masses, but no terms yet; System::node and anchorNode number the scene's points and anchors.
  virtual Contribution contribute(const Scene& scene, const System& system) = 0;
};

}  // namespace pectora
