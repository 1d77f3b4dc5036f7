// Skin, fat and muscle as a solid that keeps its volume.
#include "plugins/effect/common/cells.h"

#include "kernel/stage/effect.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class TissueEffect final : public Effect {
 public:
  void describe(Visitor&) override {}

  Contribution contribute(const Scene& scene, const System& system) override {
    Contribution part;
    if (scene.cellTissue.empty()) {
      part.emptyBecause = "the scene has no solid cells; model.volume_mesh makes them";
      return part;
    }
    std::vector<CellModuli> moduli;
    std::vector<std::size_t> counts(scene.tissues.size());
    for (const std::uint8_t t : scene.cellTissue) {
      moduli.push_back(moduliOf(scene.tissues[t].youngsModulus, scene.tissues[t].poissonsRatio));
      ++counts[t];
    }
    for (std::size_t t = 0; t < counts.size(); ++t)
      part.notes.push_back(fmt::format("{} cells of {}: E = {:.4g} kPa, nu = {:.4g}", counts[t], scene.tissues[t].name,
                                       scene.tissues[t].youngsModulus, scene.tissues[t].poissonsRatio));
    part.terms.push_back(makeCellTerm("tissue", system, moduli));
    return part;
  }
};

}  // namespace

PECTORA_EFFECT(TissueEffect, {.id = "effect.tissue", .version = "1.0",
                              .summary = "The wall is a solid: stable neo-Hookean cells that do not lock when they keep their volume",
                              .references = "Smith, de Goes and Kim, ACM TOG 2018; Nagtegaal, Parks and Rice, CMAME 1974"})
