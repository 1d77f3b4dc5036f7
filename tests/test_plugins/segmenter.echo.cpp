// Gives back its volume, and takes a list and an optional input.
#include "kernel/stage/plugin.h"
#include "kernel/value/volume.h"

namespace {
using namespace pectora;

class Echo final : public Stage {
 public:
  void describe(Visitor& v) override { v.integer("shift", shift_, "", {0, 9}, {0, 9}, "Anything"); }
  Outputs run(const Inputs& inputs, Host&) override {
    auto copy = std::make_shared<Volume>(*inputs.get<Volume>("ct"));
    copy->grid.origin.y = double(inputs.handles("more").size()) + 100 * inputs.has("mask") + 1000 * shift_;
    return {copy, copy};
  }

 private:
  int shift_ = 0;
};
}  // namespace

PECTORA_STAGE(Echo, {.id = "segmenter.echo", .version = "1.0", .summary = "Gives back its volume",
                     .inputs = {{"ct", {"Volume"}}, {.name = "mask", .kinds = {"Volume"}, .isOptional = true}, {.name = "more", .kinds = {"Volume"}, .isList = true}},
                     .outputs = {{"first", {"Volume"}}, {"second", {"Volume"}}}})
