#include "app/view/panels/anatomy_panel.h"

#include "app/view/panels/widgets.h"

#include <cmath>

namespace pectora::view {

std::optional<Vec3> AnatomyPanel::controls(Context& context) {
  const Volume* volume = context.results->volume();
  if (!volume) {
    note("Open a patient first.");
    return {};
  }
  // In which way it is shown.
  const ImVec2 half{(ImGui::GetContentRegionAvail().x - 4 * context.scale) / 2, 0};
  for (const bool isSolid : {false, true}) {
    if (isSolid) ImGui::SameLine(0, 4 * context.scale);
    ImGui::PushStyleColor(ImGuiCol_Button, isSolid == isSolid_ ? kChosen : ImGui::GetStyleColorVec4(ImGuiCol_Button));
    if (button(isSolid ? "In 3-D" : "Slices", isSolid ? "anatomy.solid" : "anatomy.slices", half)) isSolid_ = isSolid;
    ImGui::PopStyleColor();
  }
  if (!isSolid_) slices_.controls(*volume, context.scale);

  const auto place = corrections_.controls(context);
  if (place) slices_.goTo(*volume, *place);
  if (isSolid_ && corrections_.isOn()) note("A joint follows the mouse in the plane of the picture: turn the chest, and draw it again, for its depth.");

  heading("How it is found");
  for (PluginChoice* plugin : {&context.choices.segmenter, &context.choices.splines}) {
    const bool isOpen = ImGui::TreeNodeEx(plugin->id.c_str(), ImGuiTreeNodeFlags_SpanAvailWidth);
    mark(plugin->id + ".open");
    hint(context.catalog.summary(plugin->id));
    if (!isOpen) continue;
    parameterControls(context, *plugin, plugin->id);
    ImGui::TreePop();
  }

  if (!isSolid_) {
    heading("Found in it");
    slices_.legend();
  }
  if (const Anatomy* anatomy = context.results->anatomyValue()) {
    heading("Figures");
    for (const Fact& fact : anatomy->facts()) {
      const double* number = std::get_if<double>(&fact.value);
      if (!number) continue;
      const bool isCount = fact.unit.empty() && *number == std::round(*number);
      row(readable(fact.name).c_str(), (isCount ? std::to_string(int(*number)) : figure(*number)) + (fact.unit.empty() ? "" : " " + fact.unit));
    }
  }
  return isSolid_ ? place : std::nullopt;
}

}  // namespace pectora::view
