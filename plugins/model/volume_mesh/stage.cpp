#include "plugins/model/common/anchors.h"
#include "plugins/model/common/layers.h"
#include "plugins/model/volume_mesh/cells.h"
#include "plugins/model/volume_mesh/tissues.h"

#include "kernel/stage/plugin.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class VolumeMesh final : public Stage {
 public:
  void describe(Visitor& v) override {
    layers_.describe(v);
    v.integer("cells", cells_, "", {0, 30}, {0, 8}, "Cells through the wall; 0: as many as make them nearly cubic, at least 3");
    v.real("reach", reach_, "mm", {1, 1000}, {20, 80}, "Pleura further than this from every rib, cartilage and the sternum lies on the abdomen and is held in place");
    v.real("fat_modulus", fat_.youngsModulus, "kPa", {1e-6, 1e9}, {1, 20}, "Young's modulus of fat");
    v.real("muscle_modulus", muscle_.youngsModulus, "kPa", {1e-6, 1e9}, {5, 100}, "Young's modulus of passive muscle");
    v.real("bone_modulus", bone_.youngsModulus, "kPa", {1e-6, 1e9}, {100, 10000}, "Young's modulus of bone and cartilage: far stiffer than muscle is enough, since the plan moves them");
    v.real("poissons_ratio", poissonsRatio_, "", {0, 0.4999}, {0.4, 0.495}, "Poisson's ratio of fat and muscle");
  }

  Outputs run(const Inputs& inputs, Host& host) override {
    auto scene = std::make_shared<Scene>();
    scene->cage = inputs.get<RibCage>("cage");
    for (const Handle& effect : inputs.handles("effects"))
      scene->effects.push_back(std::dynamic_pointer_cast<const EffectCall>(effect.value));
    buildLayers(layers_, *scene);
    fillWall(cells_ > 0 ? cells_ : cubicCells(*scene), *scene);
    host.checkCancel();

    host.progress(0.3, "finding fat, muscle and bone");
    fat_.poissonsRatio = muscle_.poissonsRatio = poissonsRatio_;
    scene->tissues = {fat_, muscle_, bone_};
    if (const auto ct = inputs.get<Volume>("ct")) sampleTissues(*ct, *scene);
    else assumeTissues(*scene);
    weighCells(*scene);

    host.progress(0.5, "attaching the pleura");
    scene->anchors = findAnchors(*scene, reach_);
    host.info(fmt::format("{} x {} x {} cells, {:.1f} x {:.1f} x {:.1f} mm", scene->layers() - 1, scene->rows - 1, scene->columns - 1,
                          scene->thickness / (scene->layers() - 1), scene->rowSpacing, scene->columnSpacing));
    return {scene};
  }

 private:
  LayerSettings layers_;
  int cells_ = 0;
  double reach_ = 40;
  Tissue fat_{"fat", 3, 0, 930}, muscle_{"muscle", 20, 0, 1060}, bone_{"bone", 1000, 0.3, 1200};
  double poissonsRatio_ = 0.45;
};

}  // namespace

PECTORA_STAGE(VolumeMesh, {.id = "model.volume_mesh", .version = "1.0",
                           .summary = "The chest wall as a solid of cells of fat, muscle and bone, hung on the rib cage",
                           .references = "The grid of Moreira et al., SPIE 2012, with cells between skin and pleura",
                           .inputs = {{.name = "cage", .kinds = {"RibCage"}},
                                      {.name = "ct", .kinds = {"Volume"}, .isOptional = true},
                                      {.name = "effects", .kinds = {"Effect"}, .isList = true}},
                           .outputs = {{"scene", {"Scene"}}}})
