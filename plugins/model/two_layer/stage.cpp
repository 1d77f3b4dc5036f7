#include "plugins/model/two_layer/wall.h"

#include "kernel/stage/plugin.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class TwoLayer final : public Stage {
 public:
  void describe(Visitor& v) override {
    settings_.layers.describe(v);
    v.real("reach", settings_.reach, "mm", {1, 1000}, {20, 80}, "Pleura further than this from every rib, cartilage and the sternum lies on the abdomen and is held in place");
    v.real("density", settings_.density, "kg/m3", {1, 20000}, {900, 1100}, "Density of the chest wall");
  }

  Outputs run(const Inputs& inputs, Host& host) override {
    const auto scene = std::make_shared<Scene>(*wallOf(inputs.get<RibCage>("cage"), settings_, [&] {
      host.checkCancel();
      host.progress(0.5, "attaching the pleura");
    }));
    for (const Handle& effect : inputs.handles("effects"))
      scene->effects.push_back(std::dynamic_pointer_cast<const EffectCall>(effect.value));
    host.info(fmt::format("{} rows x {} columns, {:.1f} x {:.1f} mm apart, wall {:.1f} mm", scene->rows, scene->columns,
                          scene->rowSpacing, scene->columnSpacing, scene->thickness));
    return {scene};
  }

 private:
  WallSettings settings_;
};

}  // namespace

PECTORA_STAGE(TwoLayer, {.id = "model.two_layer", .version = "1.0",
                         .summary = "The chest wall as two layers of points, skin and pleura, hung on the rib cage",
                         .references = "Moreira et al., SPIE 2012",
                         .inputs = {{.name = "cage", .kinds = {"RibCage"}}, {.name = "effects", .kinds = {"Effect"}, .isList = true}},
                         .outputs = {{"scene", {"Scene"}}}})
