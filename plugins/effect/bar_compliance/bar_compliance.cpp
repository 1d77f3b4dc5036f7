// A bar bends under the chest, so that the sternum comes less far than planned.
#include "kernel/stage/layer_effect.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class BarCompliance final : public Effect {
 public:
  void describe(Visitor& v) override {
    v.real("youngs_modulus", youngsModulus_, "GPa", {1e-3, 1e6}, {50, 250}, "Young's modulus of the bar's steel");
    v.real("span", span_, "mm", {10, 1000}, {120, 300}, "Distance between the ribs that the bar rests on");
    v.real("hinge_stiffness", hinge_, "N/mm", {0, 1e9}, {0, 100}, "Stiffness of the ribs under the bar's two hinges together; 0: they do not give way");
  }

  // A straight beam on two supports: k = 48 E I / L^3, I = w h^3 / 12.
  Contribution contribute(const Scene& scene, const System&) override {
    Contribution part;
    if (!calls(scene, "effect.cartilage_bending")) {
      part.emptyBecause = "nothing pushes back on the bar; call effect.cartilage_bending";
      return part;
    }
    part.steering.barResistance = [e = youngsModulus_ * 1e3, span = span_, hinge = hinge_](const Plan& plan) {
      double sum = 0;
      for (const Bar& bar : plan.bars) {
        const double inertia = bar.width * bar.height * bar.height * bar.height / 12;
        const double stiffness = 48 * e * inertia / (span * span * span);
        sum += (hinge > 0 ? 1 / (1 / stiffness + 1 / hinge) : stiffness) * bar.lift * bar.lift;
      }
      return sum;
    };
    part.notes = {fmt::format("E = {:.4g} GPa, {:.4g} mm between its supports", youngsModulus_, span_)};
    return part;
  }

 private:
  double youngsModulus_ = 193, span_ = 220, hinge_ = 0;
};

}  // namespace

PECTORA_EFFECT(BarCompliance, {.id = "effect.bar_compliance", .version = "1.0",
                               .summary = "The bar bends under the chest: the sternum comes less far than planned",
                               .references = "k = 48 E I / L^3 in series with the chest, two bars by the same part of their lifts; 316L steel"})
