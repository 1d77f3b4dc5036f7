// correct.joint: moves a costochondral junction, or the notch where a cartilage joins the sternum.
#include "plugins/correct/common/corrections.h"

#include "kernel/stage/plugin.h"

namespace {
using namespace pectora;

class CorrectJoint final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.choice("joint", joint_, {"junction", "notch"}, "junction: where the rib ends and its cartilage begins; notch: where the cartilage joins the sternum");
    v.choice("side", side_, {"right", "left"}, "The patient's side");
    v.integer("number", number_, "", {1, 12}, {1, 10}, "Number of the rib");
    v.reals("at", at_, "mm", {-5000, 5000}, "Where it is: x, y, z (LPS)");
  }

  Outputs run(const Inputs& inputs, Host&) override {
    if (at_.size() != 3) throw Error("a point has three coordinates").of("at").given(std::to_string(at_.size()) + " numbers").allowed("x, y, z in LPS mm");
    const Vec3 at{at_[0], at_[1], at_[2]};
    const auto anatomy = inputs.get<Anatomy>("anatomy");
    const Side side = sideOf(side_);
    return {std::make_shared<Anatomy>(joint_ == "notch" ? moveNotch(*anatomy, side, number_, at) : moveJunction(*anatomy, {side, number_, {}}, at))};
  }

 private:
  std::string joint_ = "junction", side_ = "right";
  int number_ = 1;
  std::vector<double> at_;
};

}  // namespace

PECTORA_STAGE(CorrectJoint, {.id = "correct.joint", .version = "1.0", .summary = "Moves a costochondral junction or a sternal notch by hand",
                             .inputs = {{"anatomy", {"Anatomy"}}}, .outputs = {{"anatomy", {"Anatomy"}}}})
