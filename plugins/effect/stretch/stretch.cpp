// Springs between neighbouring skin points of one row or one column.
#include "kernel/stage/layer_effect.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class Stretch final : public Effect {
 public:
  void describe(Visitor& v) override { skin_.describe(v); }

  Contribution contribute(const Scene& scene, const System&) override {
    const LayerStiffness k = skin_.calibrate(scene);
    const double rows = skin_.stiffness > 0 ? skin_.stiffness : k.stretchRows;
    const double columns = skin_.stiffness > 0 ? skin_.stiffness : k.stretchColumns;
    Contribution part;
    part.stencil = {{Layer::outer, Layer::outer, 1, 0, rows, skin_.compression}, {Layer::outer, Layer::outer, 0, 1, columns, skin_.compression}};
    part.notes = {fmt::format("k = {:.4g} N/mm between rows, {:.4g} N/mm between columns", rows, columns)};
    if (!k.isIsotropic) part.notes.push_back("the cells are too oblong for an isotropic skin: bring row and column spacing closer");
    return part;
  }

 private:
  SkinSprings skin_;
};

}  // namespace

PECTORA_EFFECT(Stretch, {.id = "effect.stretch", .version = "1.0",
                         .summary = "Skin resists stretching: springs between neighbours along rows and columns",
                         .references = "Moreira et al., SPIE 2012; E = 1/2 k (l - l0)^2"})
