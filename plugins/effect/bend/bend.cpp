// Springs from a skin point to those two rows or columns away.
#include "kernel/stage/layer_effect.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class Bend final : public Effect {
 public:
  void describe(Visitor& v) override { skin_.describe(v); }

  Contribution contribute(const Scene& scene, const System&) override {
    const double weight = skin_.calibrate(scene).bendWeight;
    Contribution part;
    for (const auto& [rows, columns] : bendOffsets()) {
      // The calibrated weight is k / L^2.
      const double a = rows * scene.rowSpacing, b = columns * scene.columnSpacing;
      const double k = skin_.stiffness > 0 ? skin_.stiffness : weight * (a * a + b * b);
      part.stencil.push_back({Layer::outer, Layer::outer, rows, columns, k, skin_.compression});
    }
    part.notes = {fmt::format("k = {:.4g} N/mm and more with length", part.stencil.front().stiffnessNPerMm)};
    return part;
  }

 private:
  SkinSprings skin_;
};

}  // namespace

PECTORA_EFFECT(Bend, {.id = "effect.bend", .version = "1.0",
                      .summary = "Skin resists bending: springs to the points two rows or columns away",
                      .references = "Moreira et al., SPIE 2012; E = 1/2 k (l - l0)^2"})
