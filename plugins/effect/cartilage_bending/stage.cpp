// The costal cartilages resist being bent, and press the sternum on the bar.
#include "plugins/effect/cartilage_bending/chest.h"

#include "kernel/stage/effect.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class CartilageBending final : public Effect {
 public:
  void describe(Visitor& v) override {
    v.real("youngs_modulus", youngsModulus_, "MPa", {1e-6, 1e6}, {5, 60}, "Young's modulus of costal cartilage; calcified, it is two to four times as stiff");
    v.real("height", height_, "mm", {0.1, 100}, {10, 20}, "Height of a cartilage's section, along the body");
    v.real("depth", depth_, "mm", {0.1, 100}, {6, 14}, "Depth of a cartilage's section, from front to back: the way it is bent");
    v.real("rib_stiffness", rib_, "N/mm", {1e-6, 1e9}, {2, 10}, "Stiffness of a rib's front end against being pushed in; bodies show 3.5 to 6");
  }

  Contribution contribute(const Scene& scene, const System&) override {
    Contribution part;
    if (scene.cage->cartilages.empty()) {
      part.emptyBecause = "no costal cartilage was found";
      return part;
    }
    const double moment = secondMomentOfEllipse(height_, depth_);
    part.steering.chestResistance = [e = youngsModulus_, moment, rib = rib_](const Plan& plan) { return chestResistance(plan, e, moment, rib); };
    part.notes = {fmt::format("E I = {:.4g} N mm2, {} cartilages; the force on the bar is in the motion's bar_force", youngsModulus_ * moment, scene.cage->cartilages.size())};
    return part;
  }

 private:
  double youngsModulus_ = 25, height_ = 14, depth_ = 10, rib_ = 5;
};

}  // namespace

PECTORA_EFFECT(CartilageBending, {.id = "effect.cartilage_bending", .version = "1.0",
                                  .summary = "The costal cartilages resist being bent: the force on the bar, and what effect.bar_compliance gives way to",
                                  .references = "Guided beams, k = 12 E I / L^3; E 24.5 MPa, s41598-024-79536-3; ribs: Cavanaugh 1988"})
