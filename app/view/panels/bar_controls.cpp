#include "app/view/panels/controls.h"
#include "app/view/panels/widgets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora::view {

void barControls(Context& context) {
  if (!context.results->cageValue()) {
    note("Open a patient first.");
    return;
  }
  heading("The bar");
  parameterControls(context, context.choices.planner, "bar");
  note("In the picture the bar can be taken with the mouse: up and down is its level, forwards its lift.");

  const Plan* plan = context.results->planValue();
  if (!plan) return;
  heading("Where it lies");
  row("Intercostal space", plan->intercostalSpace > 0 ? std::to_string(plan->intercostalSpace) : "not known");
  row("Sternum turns by", fmt::format("{:.1f}°", std::abs(plan->motion.angle) * 57.29578));

  // The cartilages that give most.
  if (plan->frames.empty()) return;
  heading("Strain of the cartilages");
  std::vector<std::pair<double, std::string>> strains;
  for (std::size_t i = 0; i < plan->frames.back().size(); ++i) {
    const Cartilage& c = plan->cage->cartilages[i];
    strains.emplace_back(100 * plan->frames.back()[i].strain, fmt::format("{} {}", c.side == Side::right ? "Right" : "Left", c.rib));
  }
  std::sort(strains.begin(), strains.end(), [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
  for (std::size_t i = 0; i < std::min<std::size_t>(4, strains.size()); ++i) {
    const ImVec4* color = std::abs(strains[i].first) > 5 ? &kWarm : nullptr;
    row(strains[i].second.c_str(), fmt::format("{:+.1f} %", strains[i].first), color);
  }
}

}  // namespace pectora::view
