#include "app/view/panels/controls.h"
#include "app/view/panels/widgets.h"
#include "app/view/session/script_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace pectora::view {
namespace {

std::string shortName(const std::string& id) { return id.substr(id.find('.') + 1); }

// What an effect changes and costs, at the right of its line, if it was measured as it is now.
void tellWorth(const Context& context, const std::string& id, bool isOn) {
  const auto worth = std::find_if(context.worths.begin(), context.worths.end(), [&](const EffectWorth& w) { return w.id == id; });
  if (worth == context.worths.end() || worth->isOn != isOn) return;
  std::string text = fmt::format("{} mm · {} ms", figure(worth->largest), worth->milliseconds < 0.005 ? "< 0.01" : fmt::format("{:.2f}", worth->milliseconds));
  std::string told = fmt::format("{} it the skin would lie elsewhere by {:.2f} mm at most and {:.2f} mm RMS; it costs {:.2f} ms of each evaluation of all forces",
                                 isOn ? "Without" : "With", worth->largest, worth->rms, worth->milliseconds);
  if (!worth->refused.empty()) text = isOn ? "needed" : "cannot be solved", told = worth->refused;
  if (!worth->idle.empty()) text = "nothing to do", told = worth->idle;
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text.c_str()).x);
  ImGui::TextColored(kMuted, "%s", text.c_str());
  mark(id + ".worth");
  hint(told);
}

// "effect.j_curve" is shown as "J curve".
void effectControls(Context& context, EffectChoice& effect) {
  const std::string name = "effect." + shortName(effect.plugin.id);
  ImGui::PushID(effect.plugin.id.c_str());
  if (ImGui::Checkbox("##on", &effect.isOn)) context.changed(false);
  mark(name);
  hint("Whether the scene calls this effect");
  ImGui::SameLine();
  const bool isOpen = ImGui::TreeNodeEx(readable(shortName(effect.plugin.id)).c_str(), ImGuiTreeNodeFlags_SpanAvailWidth);
  mark(name + ".open");
  hint(context.catalog.summary(effect.plugin.id));
  tellWorth(context, effect.plugin.id, effect.isOn);
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

// One that the scene does not know yet: a tick takes it in.
void otherEffect(Context& context, const std::string& id) {
  bool isOn = false;
  ImGui::PushID(id.c_str());
  if (ImGui::Checkbox(readable(shortName(id)).c_str(), &isOn)) {
    context.choices.effects.push_back({{id}, true});
    context.changed(false);
  }
  mark("effect." + shortName(id));
  if (ImGui::IsItemHovered()) hint(context.catalog.summary(id));
  tellWorth(context, id, false);
  ImGui::PopID();
}

// A lattice has springs and volume through the wall, a solid its tissue instead.
void takeModel(Context& context, const std::string& id) {
  Choices& choices = context.choices;
  const bool isSolid = id == "model.volume_mesh";
  choices.model.id = id;
  std::erase_if(choices.model.settings, [&](const auto& setting) {
    const auto& known = context.catalog.parameters(id);
    return std::none_of(known.begin(), known.end(), [&](const Parameter& p) { return p.name == setting.first; });
  });
  for (EffectChoice& effect : choices.effects) {
    for (const char* between : {"effect.direct", "effect.cross", "effect.volume"})
      if (effect.plugin.id == between) effect.isOn = !isSolid;
    if (effect.plugin.id == "effect.tissue") effect.isOn = isSolid;
  }
  const bool hasTissue = std::any_of(choices.effects.begin(), choices.effects.end(), [](const EffectChoice& e) { return e.plugin.id == "effect.tissue"; });
  if (isSolid && !hasTissue) choices.effects.push_back({{"effect.tissue"}, true});
}

// A list of the plugins of one stage, or of those that take an input. Returns what was chosen, or nothing.
std::optional<std::string> pluginList(Context& context, const std::string& stage, const std::string& present, const std::string& input = "") {
  std::optional<std::string> chosen;
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo(("##" + stage).c_str(), present.c_str())) {
    for (const std::string& id : context.catalog.ids(stage)) {
      if (!input.empty() && !context.catalog.takes(id, input)) continue;
      if (ImGui::Selectable(id.c_str(), id == present) && id != present) chosen = id;
      mark(id);
      hint(context.catalog.summary(id));
    }
    ImGui::EndCombo();
  } else {
    mark(stage);
  }
  return chosen;
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
  if (button("Copy as Lua", "preset.copy", {-1, 0})) ImGui::SetClipboardText(presetOf(context.choices).c_str());
  hint("Effects, model, planner and solver with what was changed, as in a saved preset");
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
  ImGui::BeginDisabled(!context.results->motionValue());
  if (button("Measure what each changes", "effects.measure", {-1, 0})) context.measureEffects();
  ImGui::EndDisabled();
  std::vector<std::string> others = context.catalog.ids("effect");
  std::erase_if(others, [&](const std::string& id) {
    return std::any_of(context.choices.effects.begin(), context.choices.effects.end(), [&](const EffectChoice& e) { return e.plugin.id == id; });
  });
  if (!others.empty()) heading("More effects");
  for (const std::string& id : others) otherEffect(context, id);

  heading("Model");
  if (const auto id = pluginList(context, "model", context.choices.model.id, "cage")) {
    takeModel(context, *id);
    context.changed(false);
  }
  parameterControls(context, context.choices.model, "model");

  heading("Solver");
  if (const auto id = pluginList(context, "solver", context.choices.solver.id)) {
    context.choices.solver = {*id};
    context.changed(false);
  }
  parameterControls(context, context.choices.solver, "solver");
  presetControls(context);
}

}  // namespace pectora::view
