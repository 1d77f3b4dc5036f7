#include "plugins/comparer/anatomy/judge.h"

#include "kernel/stage/plugin.h"
#include "kernel/value/figures.h"

namespace {
using namespace pectora;

class AnatomyJudge final : public Stage {
 public:
  void describe(Visitor&) override {}

  Outputs run(const Inputs& inputs, Host&) override {
    auto figures = std::make_shared<Figures>();
    figures->list = judgeAnatomy(*inputs.get<Anatomy>("anatomy"), inputs.get<RibCage>("cage").get(), *inputs.get<Truth>("truth"));
    return {figures};
  }
};

}  // namespace

PECTORA_STAGE(AnatomyJudge, {.id = "comparer.anatomy", .version = "1.0",
                             .summary = "How far a segmented anatomy is from the truth of a phantom",
                             .inputs = {{"anatomy", {"Anatomy"}}, {"truth", {"Truth"}}, {"cage", {"RibCage"}, true}},
                             .outputs = {{"figures", {"Figures"}}}})
