#include "app/view/session/steps.h"

#include "app/view/session/scan_distances.h"

#include <filesystem>

namespace pectora::view {
namespace {

// The skins and the bar that report.files wrote.
void openResult(const Choices& choices, Runner& runner, Results& r) {
  const std::string folder = std::get<std::string>(*find(choices.loader.settings, "path"));
  const auto mesh = [&](const char* name) { return runner.run("scan.file", {{"path", folder + "/" + name}, {"units", std::string("mm")}}, {})[0]; };
  r.before = mesh("before.ply");
  r.after = mesh("after.ply");
  if (std::filesystem::exists(folder + "/bar.ply")) r.barMesh = mesh("bar.ply");
  const Mesh *before = Results::as<Mesh>(r.before), *after = Results::as<Mesh>(r.after);
  if (!before || !after || before->points.size() != after->points.size())
    throw Error("the skins before and after of this folder do not belong together").given(folder).advise("Open a folder that report.files wrote");
}

void loadPatient(const Choices& choices, Runner& runner, Results& r) {
  const auto outputs = runner.run(choices.loader.id, choices.loader.settings, Runner::PortInputs(runner.ports(choices.loader.id).size()));
  r.ct = outputs[0];
  if (choices.source == Source::phantom) r.phantomScan = outputs[2], r.phantomCtLandmarks = outputs[3], r.phantomScanLandmarks = outputs[4];
}

// One after the other; what one of them cannot do leaves those before it.
void correctAnatomy(const Choices& choices, Runner& runner, Results& r) {
  r.anatomy = r.segmented;
  for (const PluginChoice& correction : choices.corrections) r.anatomy = runner.run(correction.id, correction.settings, {{r.anatomy}})[0];
}

std::vector<Handle> effectsOf(const Choices& choices, Runner& runner) {
  std::vector<Handle> effects;
  for (const EffectChoice& effect : choices.effects)
    if (effect.isOn) effects.push_back(runner.run(effect.plugin.id, effect.plugin.settings, {})[0]);
  return effects;
}

void makeScene(const Choices& choices, Runner& runner, Results& r) {
  const std::vector<Handle> effects = effectsOf(choices, runner);
  // A lattice is made of the cage alone, a solid of the CT, too.
  Runner::PortInputs inputs;
  for (const Port& port : runner.ports(choices.model.id)) {
    const std::string name = port.name;
    inputs.push_back(name == "effects" ? effects : name == "cage" ? std::vector<Handle>{r.cage} : std::vector<Handle>{r.ct});
  }
  r.scene = runner.run(choices.model.id, choices.model.settings, inputs)[0];
}

void registerScan(const Choices& choices, Runner& runner, Results& r) {
  r.aligned = r.byLandmarks = r.byIcp = {};
  if (!r.scan.value) return;
  Handle onScan = r.phantomScanLandmarks, onCt = r.phantomCtLandmarks;
  if (choices.hasScan()) onScan = onCt = {};
  const auto placed = [&](const Landmarks& landmarks) {
    std::vector<std::string> names;
    std::vector<double> positions;
    for (const Landmark& l : landmarks.points) {
      names.push_back(l.name);
      positions.insert(positions.end(), {l.position.x, l.position.y, l.position.z});
    }
    return runner.run("scan.landmarks", {{"names", names}, {"positions", positions}}, {})[0];
  };
  if (choices.scanLandmarks.points.size() >= 3 && choices.ctLandmarks.points.size() >= 3)
    onScan = placed(choices.scanLandmarks), onCt = placed(choices.ctLandmarks);
  if (!onScan.value || !onCt.value) return;
  const auto outputs = runner.run(choices.registration.id, choices.registration.settings, {{r.scan}, {onScan}, {onCt}});
  r.aligned = outputs[0], r.byLandmarks = outputs[1];
}

void compareSurfaces(const Choices& choices, Runner& runner, Results& r) {
  r.comparison = {};
  r.scanDistances = nullptr;
  if (!r.aligned.value) return;
  // The skin before and after, as a script takes them out of the motion.
  Handle before = r.before, after = r.after;
  std::vector<Handle> copied;
  if (r.motion.value)
    for (const auto& [name, part] : r.motion.value->parts()) {
      if (name == "before") before = {part, r.motion.record};
      if (name == "after") after = {part, r.motion.record};
      if (name == "copied") copied = {{part, r.motion.record}};
    }
  if (choices.usesIcp) {
    const auto outputs = runner.run(choices.icp.id, choices.icp.settings, {{r.aligned}, {before}, {after}});
    r.aligned = outputs[0], r.byIcp = outputs[1];
  }
  r.comparison = runner.run(choices.comparer.id, choices.comparer.settings, {{r.aligned}, {after}, {before}, copied})[0];
  if (const Mesh* skin = Results::as<Mesh>(after)) r.scanDistances = std::make_shared<const std::vector<double>>(scanDistances(*r.comparisonValue(), skin->points));
}

}  // namespace

void takeEffects(const Choices& choices, Runner& runner, Results& r) {
  auto scene = std::make_shared<Scene>(*r.sceneValue());
  scene->effects.clear();
  for (const Handle& effect : effectsOf(choices, runner)) scene->effects.push_back(std::dynamic_pointer_cast<const EffectCall>(effect.value));
  r.scene = {std::move(scene), nullptr};
}

void runStep(Step step, const Choices& choices, Runner& runner, Results& r) {
  const bool isResult = choices.source == Source::result;
  if (choices.source == Source::none || (isResult && step > Step::source && step < Step::scan)) return;
  switch (step) {
    case Step::source: isResult ? openResult(choices, runner, r) : loadPatient(choices, runner, r); break;
    case Step::anatomy: r.segmented = runner.run(choices.segmenter.id, choices.segmenter.settings, {{r.ct}})[0]; break;
    case Step::corrections: correctAnatomy(choices, runner, r); break;
    case Step::cage: r.cage = runner.run(choices.splines.id, choices.splines.settings, {{r.anatomy}, {r.ct}})[0]; break;
    case Step::scene: makeScene(choices, runner, r); break;
    case Step::plan: r.plan = runner.run(choices.planner.id, choices.planner.settings, {{r.cage}})[0]; break;
    case Step::motion: break;
    case Step::scan: r.scan = choices.hasScan() ? runner.run(choices.scan.id, choices.scan.settings, {})[0] : r.phantomScan; break;
    case Step::registration: registerScan(choices, runner, r); break;
    case Step::comparison: compareSurfaces(choices, runner, r); break;
    case Step::nothing: break;
  }
}

}  // namespace pectora::view
