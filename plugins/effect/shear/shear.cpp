// Springs along the diagonals of the skin's cells.
#include "kernel/stage/layer_effect.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class Shear final : public Effect {
 public:
  void describe(Visitor& v) override { skin_.describe(v); }

  Contribution contribute(const Scene& scene, const System&) override {
    const double k = skin_.stiffness > 0 ? skin_.stiffness : skin_.calibrate(scene).shear;
    Contribution part;
    part.stencil = {{Layer::outer, Layer::outer, 1, 1, k, skin_.compression}, {Layer::outer, Layer::outer, -1, 1, k, skin_.compression}};
    part.notes = {fmt::format("k = {:.4g} N/mm", k)};
    return part;
  }

 private:
  SkinSprings skin_;
};

}  // namespace

PECTORA_EFFECT(Shear, {.id = "effect.shear", .version = "1.0",
                       .summary = "Skin resists shearing: springs along the diagonals of its cells",
                       .references = "Moreira et al., SPIE 2012; E = 1/2 k (l - l0)^2"})
