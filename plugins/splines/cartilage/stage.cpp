#include "plugins/splines/cartilage/cage.h"

#include "kernel/stage/plugin.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class CartilageSplines final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.real("control_spacing", settings_.controlSpacing, "mm", {5, 100}, {15, 40}, "Length of rib that one control point stands for");
    v.real("handle", settings_.handle, "", {0.05, 1.5}, {0.2, 0.6}, "Length of a guessed cartilage's end handles over the distance of its ends: how far it sags, where it cannot be seen");
    v.real("cartilage_hu", settings_.cartilageHu, "HU", {20, 400}, {60, 140}, "Mean of unossified cartilage in the CT");
  }

  Outputs run(const Inputs& inputs, Host& host) override {
    std::vector<std::string> warnings;
    auto cage = std::make_shared<RibCage>(buildCage(inputs.get<Anatomy>("anatomy"), inputs.get<Volume>("ct").get(), settings_, warnings, [&] { host.checkCancel(); }));
    for (const std::string& warning : warnings) host.warn(warning);
    if (cage->ribs.empty() && cage->cartilages.empty())
      throw Error("no rib was found to build on", ErrorKind::badInput).advise("Look at the slices with their contours; is this a chest?");
    return {cage};
  }

 private:
  CageSettings settings_;
};

}  // namespace

PECTORA_STAGE(CartilageSplines, {.id = "splines.cartilage", .version = "1.0",
                                 .summary = "Ribs and costal cartilages as clamped cubic B-splines",
                                 .references = "Moreira et al., SPIE 2012; de Boor 1978",
                                 .inputs = {{"anatomy", {"Anatomy"}}, {"ct", {"Volume"}, true}},
                                 .outputs = {{"cage", {"RibCage"}}}})
