#include "app/view/panels/controls.h"
#include "app/view/panels/widgets.h"
#include "app/view/session/script_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace pectora::view {
namespace {

void effectControls(Context& context, EffectChoice& effect) {
  const std::string name = "effect." + effect.plugin.id.substr(effect.plugin.id.find('.') + 1);
  ImGui::PushID(effect.plugin.id.c_str());
  if (ImGui::Checkbox("##on", &effect.isOn)) context.changed(false);
  mark(name);
  hint("Whether the scene calls this effect");
  ImGui::SameLine();
  const bool isOpen = ImGui::TreeNodeEx(readable(effect.plugin.id.substr(effect.plugin.id.find('.') + 1)).c_str(), ImGuiTreeNodeFlags_SpanAvailWidth);
  mark(name + ".open");
  hint(context.catalog.summary(effect.plugin.id));
  // What it is worth, at the right.
  for (const EffectWorth& worth : context.worths) {
    if (worth.id != effect.plugin.id || !effect.isOn) continue;
    const std::string text = worth.isNeeded ? "needed" : fmt::format("{} mm · {:.2f} ms", figure(worth.largest), worth.milliseconds);
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text.c_str()).x);
    ImGui::TextColored(kMuted, "%s", text.c_str());
    hint(worth.isNeeded ? "Without it, points are held by nothing"
                        : fmt::format("Without it the skin would lie elsewhere by {:.2f} mm at most and {:.2f} mm RMS; it costs {:.2f} ms of each evaluation of all forces",
                                      worth.largest, worth.rms, worth.milliseconds));
  }
  if (isOpen) {
    parameterControls(context, effect.plugin, name);
    for (const EffectUse& use : context.results->effects) {
      if (use.id != effect.plugin.id) continue;
      for (const std::string& told : use.notes) note(told);
      if (!use.isActive) note("Drops out: " + use.reason);
    }
    ImGui::TreePop();
  }
  ImGui::PopID();
}

void presetControls(Context& context) {
  namespace fs = std::filesystem;
  std::string& name = context.presetName;
  const fs::path folder = configFolder() / "presets";
  heading("Presets");
  ImGui::SetNextItemWidth(-150 * context.scale);
  textField("##preset", "Name", name);
  ImGui::SameLine(0, 6 * context.scale);
  if (button("Save", "preset.save")) {
    std::error_code error;
    fs::create_directories(folder, error);
    std::ofstream file(folder / (fs::path(name).filename().string() + ".lua"));
    file << presetOf(context.choices);
    context.message = file.good() ? "" : "The preset cannot be written to " + folder.string();
  }
  ImGui::SameLine(0, 6 * context.scale);
  if (button("Load…", "preset.load", {-1, 0})) ImGui::OpenPopup("presets");
  if (!ImGui::BeginPopup("presets")) return;
  bool hasAny = false;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".lua") continue;
    hasAny = true;
    if (ImGui::Selectable(entry.path().stem().string().c_str())) context.open(entry.path().string());
    mark("preset." + entry.path().stem().string());
  }
  if (!hasAny) note("None is saved yet.");
  ImGui::EndPopup();
}

}  // namespace

void tissueControls(Context& context) {
  heading("Effects of this scene");
  for (EffectChoice& effect : context.choices.effects) effectControls(context, effect);
  // Others that there are.
  if (ImGui::BeginCombo("##more", "Add an effect…")) {
    for (const std::string& id : context.catalog.ids("effect")) {
      const bool isKnown = std::any_of(context.choices.effects.begin(), context.choices.effects.end(), [&](const EffectChoice& e) { return e.plugin.id == id; });
      if (isKnown || !ImGui::Selectable((id + "  " + context.catalog.summary(id)).c_str())) continue;
      context.choices.effects.push_back({{id}, true});
      context.changed(false);
    }
    ImGui::EndCombo();
  }
  ImGui::BeginDisabled(!context.results->motionValue());
  if (button("Measure what each changes", "effects.measure", {-1, 0})) context.measureEffects();
  ImGui::EndDisabled();

  heading("Model");
  parameterControls(context, context.choices.model, "model");

  heading("Solver");
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##solver", context.choices.solver.id.c_str())) {
    for (const std::string& id : context.catalog.ids("solver")) {
      if (ImGui::Selectable(id.c_str(), id == context.choices.solver.id) && id != context.choices.solver.id) {
        context.choices.solver = {id};
        context.changed(false);
      }
      mark("solver." + id);
      hint(context.catalog.summary(id));
    }
    ImGui::EndCombo();
  } else {
    mark("solver");
  }
  parameterControls(context, context.choices.solver, "solver");
  presetControls(context);
}

}  // namespace pectora::view
