#include "app/view/session/pipeline.h"

#include "app/view/session/opened_script.h"
#include "app/view/session/steps.h"

#include <algorithm>

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

void Pipeline::update(const Choices& wanted, Clock::time_point since) {
  since_ = since;
  const Step changed = firstDifference(done_, wanted);
  if (changed == Step::nothing && hasFailed_) return;
  // A spring constant that moves makes no other wall.
  keepsWall_ = changed == Step::scene && valid_ > Step::scene && results_.sceneValue() && done_.model == wanted.model;
  done_ = wanted;
  valid_ = std::min(valid_, changed);
  runFrom(valid_, Step::plan);
  keepsWall_ = false;
  if (hasFailed_ || done_.source == Source::none) return;
  // Live where the skin can go on from where it is.
  if (valid_ > Step::motion) return;
  if (results_.motionValue()) solveLive();
}

void Pipeline::settle() {
  if (hasFailed_ || done_.source == Source::none) return;
  if (results_.isLive) valid_ = std::min(valid_, Step::motion);
  if (results_.sceneValue() && !results_.scene.record) valid_ = std::min(valid_, Step::scene);
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
  clearFrom(Step::anatomy, results_.segmented);
  clearFrom(Step::anatomy, results_.anatomy);
  clearFrom(Step::cage, results_.cage);
  if (first <= Step::cage) results_.scene = results_.plan = results_.motion = {}, results_.skin = nullptr, live_.forget(), results_.comparison = results_.aligned = {}, results_.scanDistances = nullptr;
  for (Step step = first; step <= last && step < Step::nothing; step = next(step)) {
    present_ = step;
    try {
      runOne(step);
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

void Pipeline::runOne(Step step) {
  if (step == Step::scene && keepsWall_) takeEffects(done_, runner_, results_);
  else runStep(step, done_, runner_, results_);
  if (step == Step::motion && results_.planValue()) solveFromRest();
  show();
}

WarmSolve& Pipeline::warm() {
  LiveHost host(done_.solver.id, messages_, cancel_);
  WarmSolve& solve = live_.ready(std::dynamic_pointer_cast<const Scene>(results_.scene.value), done_.solver, results_.motionValue(), host);
  results_.effects = solve.compiled().effects;
  return solve;
}

void Pipeline::solveLive() {
  present_ = Step::motion;
  FollowingHost host(done_.solver.id, messages_, cancel_);
  const Clock::time_point begun = Clock::now();
  try {
    WarmSolve& solve = warm();
    if (!live_.isWarm()) {
      present_ = Step::nothing;
      return;
    }
    showsWay_ = true;
    lastSeen_ = {};   // of this solve alone: another's nodes may be others
    const auto motion = solve.solve(*results_.planValue(), host);
    results_.motion = {motion, nullptr};
    results_.skin = std::shared_ptr<const std::vector<Vec3>>(motion, &motion->outer);
    results_.isPreview = false;
    results_.isLive = true;
    results_.settled = -1;
    results_.liveMs = msSince(since_);
    results_.solveMs = msSince(begun);
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
  // A display shows no more than about thirty states a second; the last one before the hand moves on is where it goes on from.
  if (!showsWay_ || (msSince(shown_) < 30 && !cancel_) || !results_.sceneValue()) return;
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
  const Motion* with = results_.motionValue();
  if (!with || hasFailed_) return {};
  showsWay_ = false;
  LiveHost host(done_.solver.id, messages_, cancel_);
  return view::measureEffects(done_, *results_.sceneValue(), *results_.planValue(), *with, warm().compiled(), registry_, host, progress);
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

std::pair<Landmarks, Landmarks> Pipeline::landmarksIn(const std::string& path) {
  const auto side = [&](const char* set) { return *Results::as<Landmarks>(runner_.run("scan.landmarks", {{"path", path}, {"set", std::string(set)}}, {})[0]); };
  return {side("ct"), side("scan")};
}

Choices Pipeline::openedScript(const Choices& present, const std::string& path) {
  return view::openedScript(present, path, runner_, registry_, messages_, cancel_, calls_);
}

}  // namespace pectora::view
