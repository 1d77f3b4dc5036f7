// The spring from each skin point to its own pleura point.
#include "kernel/stage/wall_effect.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class Direct final : public Effect {
 public:
  void describe(Visitor& v) override { wall_.describe(v); }

  Contribution contribute(const Scene& scene, const System&) override {
    Contribution part;
    part.emptyBecause = WallSprings::emptyBecause(scene);
    if (!part.emptyBecause.empty()) return part;
    const double k = wall_.stiffness > 0 ? wall_.stiffness : wall_.calibrate(scene, part.notes).at(0, 0);
    part.stencil = {{Layer::outer, Layer::inner, 0, 0, k}};
    part.notes.push_back(fmt::format("k = {:.4g} N/mm", k));
    return part;
  }

 private:
  WallSprings wall_;
};

}  // namespace

PECTORA_EFFECT(Direct, {.id = "effect.direct", .version = "1.0",
                        .summary = "The wall keeps its thickness: a spring from each skin point to its pleura point",
                        .references = "Moreira et al., SPIE 2012; E = 1/2 k (l - l0)^2"})
