#include "plugins/model/hard_case/hard_case.h"

#include "kernel/stage/plugin.h"

namespace {
using namespace pectora;

class HardCaseStage final : public Stage {
 public:
  void describe(Visitor& v) override {
    std::vector<std::string> names = hardCaseNames();
    names.push_back("random");
    v.choice("name", name_, names, "Which case; random: one drawn from the seed");
    v.integer("size", size_, "", {3, 200}, {5, 40}, "Points a side");
    v.integer("seed", seed_, "", {0, 2e9}, {0, 1000}, "Seed of what is left to chance");
  }
  Outputs run(const Inputs&, Host&) override {
    return {name_ == "random" ? makeRandomCase(unsigned(seed_)) : makeHardCase(name_, size_, unsigned(seed_))};
  }

 private:
  std::string name_ = hardCaseNames().front();
  int size_ = 9, seed_ = 1;
};

}  // namespace

PECTORA_STAGE(HardCaseStage, {.id = "model.hard_case", .version = "1.0",
                              .summary = "A scene that is hard to solve, its plan and start, and what must hold for it",
                              .outputs = {{"case", {"HardCase"}}}})
