#include "app/view/session/opened_script.h"

#include <algorithm>

namespace pectora::view {
namespace {

// What a preset sets, and of the rest what there is.
Choices withPreset(Choices choices, const ScriptEngine& engine, Runner& runner, const std::string& path) {
  const std::vector<Handle> effects = engine.handles("effects");
  if (effects.empty()) throw Error("the file is neither a script that predicts nor a preset: it loads no patient and sets no list \"effects\"").given(path).advise("Open a script that begins with a loader, or a preset that the window saved");
  for (EffectChoice& effect : choices.effects) effect.isOn = false;
  for (const Handle& handle : effects) {
    const auto* call = dynamic_cast<const EffectCall*>(handle.value.get());
    if (!call) throw Error("an entry of \"effects\" is no effect").given(path);
    const auto known = std::find_if(choices.effects.begin(), choices.effects.end(), [&](const EffectChoice& e) { return e.plugin.id == call->id; });
    if (known == choices.effects.end()) choices.effects.push_back({{call->id, call->settings}, true});
    else *known = {{call->id, call->settings}, true};
  }
  const auto part = [&](const std::string& name, PluginChoice& plugin) {
    if (const std::string id = engine.text(name + "_name"); !id.empty()) plugin = {id, engine.settings(name + "_settings")};
    runner.parametersOf(plugin.id);   // throws if there is no such plugin
  };
  part("model", choices.model);
  part("planner", choices.planner);
  part("solver", choices.solver);
  return choices;
}

}  // namespace

Choices openedScript(const Choices& present, const std::string& path, Runner& runner, Registry& registry, Messages& messages,
                     std::atomic<bool>& cancel, ScriptCalls*& listener) {
  ScriptEngine engine(runner, registry, cancel, {});
  std::vector<std::pair<std::string, std::string>> arguments;
  const SettingValue* ct = present.source == Source::dicom ? find(present.loader.settings, "path") : nullptr;
  if (ct)
    for (const Parameter& p : engine.parametersOf(path))
      if (p.name == "ct") arguments.emplace_back("ct", std::get<std::string>(*ct));

  // What is solved on the way is kept by the runner, and found again when the choices are carried out.
  ScriptCalls calls;
  const struct Listening {
    ScriptCalls*& to;
    ~Listening() { to = nullptr; }
  } listening{listener};
  listener = &calls;
  try {
    engine.run(path, arguments);
  } catch (const Cancelled&) {
    if (cancel.load()) throw;   // by the user; otherwise the script has come as far as is shown
  } catch (const Error& error) {
    if (!calls.hasPrediction()) throw;
    messages.warn("script", error.what());   // what came before can be shown
  }
  if (calls.hasPatient()) return calls.choices(present);
  return withPreset(present, engine, runner, path);
}

}  // namespace pectora::view
