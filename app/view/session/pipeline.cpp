#include "app/view/session/pipeline.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace pectora::view {
namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) { return std::chrono::duration<double, std::milli>(Clock::now() - start).count(); }

Settings accepting(Settings settings) {
  assign(settings, kAcceptUnconverged, true);   // the window shows the status instead
  return settings;
}

double largestDistance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, distance(a[i], b[i]));
  return largest;
}

Step next(Step step) { return Step(int(step) + 1); }

}  // namespace

Pipeline::Pipeline(Registry& registry, Messages& messages, std::atomic<bool>& cancel, Show show, std::function<void(const std::string&)> print)
    : registry_(registry), messages_(messages), cancel_(cancel), show_(std::move(show)), runner_(registry, messages, cancel),
      live_(registry), console_(runner_, registry, cancel, ScriptOptions{{}, std::move(print)}) {}

void Pipeline::show() { show_(std::make_shared<const Results>(results_)); }

std::vector<Handle> Pipeline::run(const PluginChoice& plugin, const Runner::PortInputs& inputs) { return runner_.run(plugin.id, plugin.settings, inputs); }

void Pipeline::update(const Choices& wanted, Clock::time_point since) {
  since_ = since;
  const Step changed = firstDifference(done_, wanted);
  if (changed == Step::nothing && hasFailed_) return;
  done_ = wanted;
  valid_ = std::min(valid_, changed);
  runFrom(valid_, Step::plan);
  if (hasFailed_ || done_.source == Source::none) return;
  // Live where the skin can go on from where it is.
  if (valid_ > Step::motion) return;
  if (results_.motionValue()) solveLive();
}

void Pipeline::settle() {
  if (hasFailed_ || done_.source == Source::none) return;
  if (results_.isLive) valid_ = std::min(valid_, Step::motion);
  runFrom(valid_, Step::comparison);
}

void Pipeline::runFrom(Step first, Step last) {
  hasFailed_ = false;
  // What the changed steps made is of no use; the skin stays until there is another.
  const auto clearFrom = [&](Step step, Handle& handle) {
    if (first <= step) handle = {};
  };
  if (last == Step::plan && first <= Step::plan) results_.error.clear();
  clearFrom(Step::source, results_.ct);
  for (Handle* handle : {&results_.before, &results_.after, &results_.barMesh}) clearFrom(Step::source, *handle);
  clearFrom(Step::source, results_.phantomScan);
  clearFrom(Step::source, results_.phantomCtLandmarks);
  clearFrom(Step::source, results_.phantomScanLandmarks);
  clearFrom(Step::anatomy, results_.anatomy);
  clearFrom(Step::cage, results_.cage);
  if (first <= Step::cage) results_.scene = results_.plan = results_.motion = {}, results_.skin = nullptr, live_.forget(), results_.comparison = results_.aligned = {};
  for (Step step = first; step <= last && step < Step::nothing; step = next(step)) {
    present_ = step;
    try {
      runStep(step);
      valid_ = next(step);
    } catch (const Error& error) {
      results_.error = error.what();
      results_.isPreview = false;
      hasFailed_ = true;
      show();
      present_ = Step::nothing;
      return;
    } catch (const Cancelled&) {
      results_.isPreview = false;
      present_ = Step::nothing;
      show();
      throw;
    }
  }
  present_ = Step::nothing;
}

void Pipeline::runStep(Step step) {
  Results& r = results_;
  if (done_.source == Source::none) return;
  if (done_.source == Source::result && step > Step::source && step < Step::scan) return;
  switch (step) {
    case Step::source: {
      if (done_.source == Source::result) {
        openResult();
        break;
      }
      const auto outputs = run(done_.loader, Runner::PortInputs(runner_.ports(done_.loader.id).size()));
      r.ct = outputs[0];
      if (done_.source == Source::phantom) r.phantomScan = outputs[2], r.phantomCtLandmarks = outputs[3], r.phantomScanLandmarks = outputs[4];
      break;
    }
    case Step::anatomy: r.anatomy = run(done_.segmenter, {{r.ct}})[0]; break;
    case Step::cage: r.cage = run(done_.splines, {{r.anatomy}, {r.ct}})[0]; break;
    case Step::scene: {
      std::vector<Handle> effects;
      for (const EffectChoice& effect : done_.effects)
        if (effect.isOn) effects.push_back(run(effect.plugin, {})[0]);
      // A lattice is made of the cage alone, a solid of the CT, too.
      Runner::PortInputs inputs;
      for (const Port& port : runner_.ports(done_.model.id)) {
        const std::string name = port.name;
        inputs.push_back(name == "effects" ? effects : name == "cage" ? std::vector<Handle>{r.cage} : std::vector<Handle>{r.ct});
      }
      r.scene = run(done_.model, inputs)[0];
      break;
    }
    case Step::plan: r.plan = run(done_.planner, {{r.cage}})[0]; break;
    case Step::motion: solveFromRest(); break;
    case Step::scan:
      r.scan = !done_.scanPath.empty() ? runner_.run("scan.file", {{"path", done_.scanPath}}, {})[0] : r.phantomScan;
      break;
    case Step::registration: {
      r.aligned = r.byLandmarks = r.byIcp = {};
      if (!r.scan.value) break;
      Handle onScan = r.phantomScanLandmarks, onCt = r.phantomCtLandmarks;
      if (!done_.scanPath.empty()) onScan = onCt = {};
      const auto placed = [&](const Landmarks& landmarks) {
        std::vector<std::string> names;
        std::vector<double> positions;
        for (const Landmark& l : landmarks.points) {
          names.push_back(l.name);
          positions.insert(positions.end(), {l.position.x, l.position.y, l.position.z});
        }
        return runner_.run("scan.landmarks", {{"names", names}, {"positions", positions}}, {})[0];
      };
      if (done_.scanLandmarks.points.size() >= 3 && done_.ctLandmarks.points.size() >= 3) onScan = placed(done_.scanLandmarks), onCt = placed(done_.ctLandmarks);
      if (!onScan.value || !onCt.value) break;
      const auto outputs = runner_.run("register.landmarks", {{"method", done_.registration}}, {{r.scan}, {onScan}, {onCt}});
      r.aligned = outputs[0], r.byLandmarks = outputs[1];
      break;
    }
    case Step::comparison: {
      r.comparison = {};
      if (!r.aligned.value) break;
      // The skin before and after, as a script takes them out of the motion.
      Handle before = r.before, after = r.after, copied;
      if (r.motion.value)
        for (const auto& [name, part] : r.motion.value->parts()) {
          if (name == "before") before = {part, r.motion.record};
          if (name == "after") after = {part, r.motion.record};
          if (name == "copied") copied = {part, r.motion.record};
        }
      if (done_.usesIcp) {
        const auto outputs = runner_.run("register.icp", {}, {{r.aligned}, {before}, {after}});
        r.aligned = outputs[0], r.byIcp = outputs[1];
      }
      r.comparison = runner_.run("comparer.surface", {{"name", std::string("scan_vs_simulated")}}, {{r.aligned}, {after}, {before}, copied.value ? std::vector<Handle>{copied} : std::vector<Handle>{}})[0];
      break;
    }
    case Step::nothing: break;
  }
  show();
}

// The skins and the bar that report.files wrote.
void Pipeline::openResult() {
  const std::string folder = std::get<std::string>(*find(done_.loader.settings, "path"));
  const auto mesh = [&](const char* name) { return runner_.run("scan.file", {{"path", folder + "/" + name}, {"units", std::string("mm")}}, {})[0]; };
  results_.before = mesh("before.ply");
  results_.after = mesh("after.ply");
  if (std::filesystem::exists(folder + "/bar.ply")) results_.barMesh = mesh("bar.ply");
  const Mesh *before = Results::as<Mesh>(results_.before), *after = Results::as<Mesh>(results_.after);
  if (!before || !after || before->points.size() != after->points.size())
    throw Error("the skins before and after of this folder do not belong together").given(folder).advise("Open a folder that report.files wrote");
}

WarmSolve& Pipeline::warm() {
  LiveHost host(done_.solver.id, messages_, cancel_);
  WarmSolve& solve = live_.ready(std::dynamic_pointer_cast<const Scene>(results_.scene.value), done_.solver, results_.motionValue(), host);
  results_.effects = solve.compiled().effects;
  return solve;
}

void Pipeline::solveLive() {
  present_ = Step::motion;
  LiveHost host(done_.solver.id, messages_, cancel_);
  try {
    WarmSolve& solve = warm();
    if (!live_.isWarm()) {
      present_ = Step::nothing;
      return;
    }
    showsWay_ = true;
    const auto motion = solve.solve(*results_.planValue(), host);
    results_.motion = {motion, nullptr};
    results_.skin = std::shared_ptr<const std::vector<Vec3>>(motion, &motion->outer);
    results_.isPreview = false;
    results_.isLive = true;
    results_.settled = -1;
    results_.liveMs = msSince(since_);
    valid_ = Step::scan;
    show();
  } catch (const Cancelled&) {
    // The next solve goes on from what was last seen.
    if (lastSeen_.size() > 0) warm().startFrom(std::move(lastSeen_));
    lastSeen_ = {};
    results_.isLive = true;
    present_ = Step::nothing;
    throw;
  } catch (const Error& error) {
    results_.error = error.what();
    hasFailed_ = true;
    live_.forget();
    show();
  }
  lastSeen_ = {};
  present_ = Step::nothing;
}

void Pipeline::solveFromRest() {
  const bool wasLive = results_.isLive && !results_.isPreview && results_.skin;
  const auto live = results_.skin;
  warm();
  showsWay_ = !wasLive;   // a check of the live skin does not take it away
  const Handle motion = runner_.run(done_.solver.id, accepting(done_.solver.settings), {{results_.scene}, {results_.plan}, {}})[0];
  results_.motion = motion;
  const auto value = std::dynamic_pointer_cast<const Motion>(motion.value);
  results_.skin = std::shared_ptr<const std::vector<Vec3>>(value, &value->outer);
  results_.settled = wasLive && live->size() == value->outer.size() ? largestDistance(*live, value->outer) : -1;
  results_.isPreview = results_.isLive = false;
  live_.startFrom(*value);
}

void Pipeline::preview(const NodeVectors& positions) {
  // A display shows no more than about thirty states a second.
  if (!showsWay_ || msSince(shown_) < 30 || !results_.sceneValue()) return;
  shown_ = Clock::now();
  const std::size_t count = std::size_t(results_.sceneValue()->points());
  lastSeen_ = positions;
  auto skin = std::make_shared<std::vector<Vec3>>();
  skin->reserve(count);
  for (std::size_t i = 0; i < count; ++i) skin->push_back(positions[i]);
  results_.skin = std::move(skin);
  results_.isPreview = true;
  show();
}

std::vector<PickedSpring> Pipeline::springsAt(int point) {
  std::vector<PickedSpring> found;
  const Motion* motion = results_.motionValue();
  if (!motion || hasFailed_) return found;
  const System& system = *warm().compiled().system;
  const std::size_t node = std::size_t(point);
  if (node >= motion->outer.size() || motion->outer.size() != system.points()) return found;
  const auto place = [&](std::size_t i) {
    const std::size_t layer = i / system.points();
    return layer < std::size_t(system.layers) ? motion->layer(int(layer))[i % system.points()] : motion->anchors.at(i - system.anchorNode(0));
  };
  for (const auto& term : system.terms)
    term->forEachSpring([&](const Spring& s) {
      if (s.a != node && s.b != node) return;
      const Vec3 from = place(node), to = place(s.a == node ? s.b : s.a);
      const double length = distance(from, to), k = s.stiffnessNPerMm * (length < s.restLength ? s.compression : 1);
      found.push_back({from, to, k, s.restLength > 0 ? length / s.restLength - 1 : 0, k * (length - s.restLength)});
    });
  return found;
}

std::vector<EffectWorth> Pipeline::measureEffects(const std::function<void(double, const std::string&)>& progress) {
  std::vector<EffectWorth> worths;
  const Motion* with = results_.motionValue();
  if (!with || hasFailed_) return worths;
  showsWay_ = false;
  // The best of five evaluations of all forces.
  const auto cost = [](const System& system) {
    NodeVectors gradient(system.rest.size());
    double best = INFINITY, largest = 0;
    for (int i = 0; i < 5; ++i) {
      const auto start = Clock::now();
      system.evaluate(system.rest, gradient, largest);
      best = std::min(best, msSince(start));
    }
    return best;
  };
  const double whole = cost(*warm().compiled().system);
  LiveHost host(done_.solver.id, messages_, cancel_);
  for (std::size_t i = 0; i < done_.effects.size(); ++i) {
    if (!done_.effects[i].isOn) continue;
    EffectWorth worth;
    worth.id = done_.effects[i].plugin.id;
    progress(double(i) / double(done_.effects.size()), "without " + worth.id);
    auto scene = std::make_shared<Scene>(*results_.sceneValue());
    std::erase_if(scene->effects, [&](const auto& call) { return call->id == worth.id; });
    try {
      WarmSolve without(scene, done_.solver.id, makeSolver(registry_, done_.solver), registry_, host);
      worth.milliseconds = std::max(0.0, whole - cost(*without.compiled().system));
      // A guide less, such as of a bar that gives way, and the motion is another scene's: then from rest.
      const System& system = *without.compiled().system;
      if (with->anchors.size() == system.rest.size() - system.freeNodes) without.startFrom(*with);
      const auto motion = without.solve(*results_.planValue(), host);
      double sum = 0;
      for (std::size_t p = 0; p < with->outer.size(); ++p) {
        const double d = distance(with->outer[p], motion->outer[p]);
        worth.largest = std::max(worth.largest, d);
        sum += d * d;
      }
      worth.rms = std::sqrt(sum / double(with->outer.size()));
    } catch (const Error&) {
      worth.isNeeded = true;
    }
    worths.push_back(worth);
  }
  return worths;
}

Study Pipeline::study(const std::function<void(double, const std::string&)>& progress) {
  if (!results_.planValue() || !results_.sceneValue() || hasFailed_) throw Error("there is no scene to study yet");
  return studyScene(std::dynamic_pointer_cast<const Scene>(results_.scene.value), *results_.planValue(), done_.solver, registry_, cancel_, progress);
}

void Pipeline::exportTo(const std::string& folder) {
  settle();
  const Results& r = results_;
  if (!r.motion.value || !r.motion.record) throw Error("there is no result to export yet");
  const auto one = [](const Handle& h) { return h.value ? std::vector<Handle>{h} : std::vector<Handle>{}; };
  std::vector<Handle> registrations = one(r.byLandmarks);
  if (r.byIcp.value) registrations.push_back(r.byIcp);
  Runner::PortInputs inputs{one(r.ct), one(r.anatomy), one(r.cage), one(r.scene), one(r.plan), one(r.motion), registrations, one(r.comparison), one(r.aligned)};
  runner_.run("report.files", {{"path", folder}}, inputs);
}

void Pipeline::evaluate(const std::string& code) {
  settle();
  const std::pair<const char*, const Handle*> names[] = {{"ct", &results_.ct}, {"anatomy", &results_.anatomy}, {"cage", &results_.cage},
    {"scene", &results_.scene}, {"plan", &results_.plan}, {"motion", &results_.motion}, {"aligned", &results_.aligned}, {"comparison", &results_.comparison}};
  for (const auto& [name, handle] : names)
    if (handle->value && handle->record) console_.define(name, *handle);
  console_.evaluate(code);
}

void Pipeline::starting(const std::string& id, const Settings& settings, const Runner::PortInputs& inputs) {
  if (calls_) calls_->starting(id, settings, inputs);
}

Choices Pipeline::openedScript(const Choices& present, const std::string& path) {
  ScriptEngine engine(runner_, registry_, cancel_, {});
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
  } listening{calls_};
  calls_ = &calls;
  try {
    engine.run(path, arguments);
  } catch (const Cancelled&) {
    if (cancel_.load()) throw;   // by the user; otherwise the script has come as far as is shown
  } catch (const Error& error) {
    if (!calls.hasPrediction()) throw;
    messages_.warn("script", error.what());   // what came before can be shown
  }
  if (calls.hasPatient()) return calls.choices(present);
  return withPreset(present, engine, path);
}

Choices Pipeline::withPreset(Choices choices, const ScriptEngine& engine, const std::string& path) {
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
    runner_.parametersOf(plugin.id);   // throws if there is no such plugin
  };
  part("model", choices.model);
  part("planner", choices.planner);
  part("solver", choices.solver);
  return choices;
}

}  // namespace pectora::view
