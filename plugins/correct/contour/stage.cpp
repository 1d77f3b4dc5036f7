// correct.contour: gives the outline of skin, pleura or sternum at one level.
#include "plugins/correct/common/corrections.h"

#include "kernel/stage/plugin.h"

namespace {
using namespace pectora;

class CorrectContour final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.choice("structure", structure_, {"skin", "pleura", "sternum"}, "What it is the outline of");
    v.real("z", z_, "mm", {-5000, 5000}, {-500, 500}, "Level (LPS)");
    v.reals("points", points_, "mm", {-5000, 5000}, "x and y of its points in turn (LPS): from the patient's right to his left for skin and pleura, around for the sternum");
  }

  Outputs run(const Inputs& inputs, Host&) override {
    if (points_.size() % 2 != 0) throw Error("x and y come in pairs").of("points").given(std::to_string(points_.size()) + " numbers");
    std::vector<Vec3> points;
    for (std::size_t n = 0; n < points_.size(); n += 2) points.push_back({points_[n], points_[n + 1], z_});
    return {std::make_shared<Anatomy>(giveContour(*inputs.get<Anatomy>("anatomy"), structure_, z_, points))};
  }

 private:
  std::string structure_ = "skin";
  double z_ = 0;
  std::vector<double> points_;
};

}  // namespace

PECTORA_STAGE(CorrectContour, {.id = "correct.contour", .version = "1.0", .summary = "Gives the outline of skin, pleura or sternum at one level by hand",
                               .inputs = {{"anatomy", {"Anatomy"}}}, .outputs = {{"anatomy", {"Anatomy"}}}})
