// correct.rib: drops a rib, or gives it another number.
#include "plugins/correct/common/corrections.h"

#include "kernel/stage/plugin.h"

namespace {
using namespace pectora;

class CorrectRib final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.choice("side", side_, {"right", "left"}, "The patient's side");
    v.integer("number", number_, "", {0, 12}, {1, 12}, "Number of the rib; 0: the rib of that side nearest to the point `near`");
    v.reals("near", near_, "mm", {-5000, 5000}, "A point near a rib without a number: x, y, z (LPS)");
    v.integer("as", as_, "", {0, 12}, {0, 12}, "Its new number; 0: the rib is dropped");
  }

  Outputs run(const Inputs& inputs, Host&) override {
    if (!near_.empty() && near_.size() != 3) throw Error("a point has three coordinates").of("near").given(std::to_string(near_.size()) + " numbers");
    RibChoice choice{sideOf(side_), number_, {}};
    if (!near_.empty()) choice.near = Vec3{near_[0], near_[1], near_[2]};
    const auto anatomy = inputs.get<Anatomy>("anatomy");
    return {std::make_shared<Anatomy>(as_ == 0 ? dropRib(*anatomy, choice) : renumberRib(*anatomy, choice, as_))};
  }

 private:
  std::string side_ = "right";
  int number_ = 0, as_ = 0;
  std::vector<double> near_;
};

}  // namespace

PECTORA_STAGE(CorrectRib, {.id = "correct.rib", .version = "1.0", .summary = "Drops a rib that is none, or gives it its right number, by hand",
                           .inputs = {{"anatomy", {"Anatomy"}}}, .outputs = {{"anatomy", {"Anatomy"}}}})
