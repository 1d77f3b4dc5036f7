#include "app/view/panels/controls.h"
#include "app/view/panels/widgets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora::view {
namespace {

constexpr double kSecondAbove = 40;   // where a second bar begins, mm above the first

// The planner's parameters by what they are about, which their names tell.
enum class About { bar, secondBar, shape };
About aboutOf(const std::string& name) { return name.starts_with("second_") ? About::secondBar : name.starts_with("bar_") ? About::shape : About::bar; }

void parametersAbout(Context& context, About about) {
  for (const Parameter& p : context.catalog.parameters(context.choices.planner.id))
    if (aboutOf(p.name) == about) parameterControl(context, p, context.choices.planner.settings, "bar." + p.name);
}

// A second bar is there if its level is not 0.
void secondBar(Context& context) {
  Settings& settings = context.choices.planner.settings;
  const auto& known = context.catalog.parameters(context.choices.planner.id);
  if (std::none_of(known.begin(), known.end(), [](const Parameter& p) { return p.name == "second_level"; })) return;
  bool isThere = context.catalog.number(context.choices.planner.id, settings, "second_level") != 0;
  if (ImGui::Checkbox("A second bar", &isThere)) {
    if (isThere) {
      // It begins where it changes nothing: at the lift that the first brings about there.
      assign(settings, "second_level", kSecondAbove);
      if (const Plan* plan = context.results->planValue(); plan && !plan->bars.empty()) {
        const Vec3 above = plan->bars.front().point + Vec3{0, 0, kSecondAbove};
        assign(settings, "second_lift", std::round(10 * std::max(0.0, above.y - plan->motion(above).y)) / 10);
      }
    } else {
      std::erase_if(settings, [](const auto& setting) { return aboutOf(setting.first) == About::secondBar; });
    }
    context.changed(false);
  }
  mark("bar.second");
  hint("Both lifts together then fix how the sternum turns and comes forward");
  if (isThere) parametersAbout(context, About::secondBar);
}

std::string spaces(const Bar& bar) {
  const auto one = [](int space) { return space > 0 ? std::to_string(space) : std::string("?"); };
  return bar.rightSpace == bar.leftSpace ? one(bar.rightSpace) : fmt::format("R {}, L {}", one(bar.rightSpace), one(bar.leftSpace));
}

}  // namespace

void barControls(Context& context) {
  if (!context.results->cageValue()) {
    note("Open a patient first.");
    return;
  }
  heading("The bar");
  parametersAbout(context, About::bar);
  secondBar(context);
  const bool isOpen = ImGui::TreeNode("Its steel");
  mark("bar.shape.open");
  if (isOpen) {
    parametersAbout(context, About::shape);
    ImGui::TreePop();
  }
  note("In the picture a bar can be taken with the mouse: its middle up and down is the level, forwards the lift; its ends tilt it.");

  const Plan* plan = context.results->planValue();
  if (!plan) return;
  heading("Where it lies");
  for (const Bar& bar : plan->bars) {
    row(&bar == &plan->bars.front() ? "Intercostal space" : "Second bar's space", spaces(bar));
    hint("Below the rib of that number, where its cartilage joins the sternum");
  }
  row("Sternum turns by", fmt::format("{:.1f}°", std::abs(plan->motion.angle) * 57.29578));
  if (plan->bars.size() > 1) {
    row("Its axis comes forward", fmt::format("{:.1f} mm", -plan->motion.translation.y));
    hint("Two bars fix how the sternum lies; one bar turns it about the axis, which then stays");
  }

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
