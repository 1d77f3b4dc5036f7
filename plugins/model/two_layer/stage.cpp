#include "plugins/model/common/anchors.h"
#include "plugins/model/common/layers.h"
#include "plugins/model/two_layer/masses.h"

#include "kernel/stage/plugin.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class TwoLayer final : public Stage {
 public:
  void describe(Visitor& v) override {
    settings_.describe(v);
    v.real("reach", reach_, "mm", {1, 1000}, {20, 80}, "Pleura further than this from every rib, cartilage and the sternum lies on the abdomen and is held in place");
    v.real("density", density_, "kg/m3", {1, 20000}, {900, 1100}, "Density of the chest wall");
  }

  Outputs run(const Inputs& inputs, Host& host) override {
    auto scene = std::make_shared<Scene>();
    scene->cage = inputs.get<RibCage>("cage");
    for (const Handle& effect : inputs.handles("effects"))
      scene->effects.push_back(std::dynamic_pointer_cast<const EffectCall>(effect.value));
    buildLayers(settings_, *scene);
    weighLayers(density_, *scene);
    host.checkCancel();
    host.progress(0.5, "attaching the pleura");
    scene->anchors = findAnchors(*scene, reach_);
    host.info(fmt::format("{} rows x {} columns, {:.1f} x {:.1f} mm apart, wall {:.1f} mm", scene->rows, scene->columns,
                          scene->rowSpacing, scene->columnSpacing, scene->thickness));
    return {scene};
  }

 private:
  LayerSettings settings_;
  double reach_ = 40, density_ = 1060;
};

}  // namespace

PECTORA_STAGE(TwoLayer, {.id = "model.two_layer", .version = "1.0",
                         .summary = "The chest wall as two layers of points, skin and pleura, hung on the rib cage",
                         .references = "Moreira et al., SPIE 2012",
                         .inputs = {{.name = "cage", .kinds = {"RibCage"}}, {.name = "effects", .kinds = {"Effect"}, .isList = true}},
                         .outputs = {{"scene", {"Scene"}}}})
