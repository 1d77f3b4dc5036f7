#include "plugins/effect/cartilage_bending/chest.h"

#include <numbers>

namespace pectora {

double secondMomentOfEllipse(double height, double depth) { return std::numbers::pi / 64 * height * depth * depth * depth; }

double chestResistance(const Plan& plan, double youngsModulus, double secondMoment, double ribStiffness) {
  if (plan.frames.empty()) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < plan.cage->cartilages.size(); ++i) {
    const Cartilage& cartilage = plan.cage->cartilages[i];
    const double length = cartilage.curve.length();
    if (!(length > 0)) continue;
    const double way = distance(plan.frames.back()[i].curve.at(1), cartilage.curve.at(1));
    const double beam = 12 * youngsModulus * secondMoment / (length * length * length);
    sum += way * way / (1 / beam + 1 / ribStiffness);
  }
  return sum;
}

}  // namespace pectora
