// Tells how many effects it was given.
#include "kernel/stage/plugin.h"
#include "kernel/value/scene.h"

namespace {
using namespace pectora;

struct Count : Value {
  double count = 0;
  const char* kind() const override { return "Count"; }
  std::vector<Fact> facts() const override { return {{"count", count, ""}}; }
};

class Effects final : public Stage {
 public:
  void describe(Visitor&) override {}
  Outputs run(const Inputs& inputs, Host&) override {
    auto count = std::make_shared<Count>();
    count->count = double(inputs.handles("effects").size());
    return {count};
  }
};

}  // namespace

PECTORA_STAGE(Effects, {.id = "segmenter.effects", .version = "1.0", .summary = "Counts effects",
                        .inputs = {{.name = "effects", .kinds = {"Effect"}, .isList = true}}, .outputs = {{"count", {"Count"}}}})
