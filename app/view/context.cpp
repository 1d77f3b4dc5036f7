#include "app/view/context.h"

#include "app/view/platform/target.h"

#include <filesystem>
#include <fstream>

namespace pectora::view {

namespace fs = std::filesystem;

constexpr std::size_t kSameWarning = 40;   // letters that tell what a warning is about; figures follow

void Layout::load() {
  std::ifstream file(stateFolder() / "layout");
  Layout kept;
  if (!(file >> kept.left >> kept.right >> kept.console >> kept.width >> kept.height)) return;
  const auto isSound = [](double value, double least, double most) { return value >= least && value <= most; };
  const bool areColumns = isSound(kept.left, 100, 2000) && isSound(kept.right, 100, 2000) && isSound(kept.console, 50, 2000);
  if (areColumns && isSound(kept.width, kLeastWidth, 10000) && isSound(kept.height, kLeastHeight, 10000)) *this = kept;
}

void Layout::save() const { std::ofstream(stateFolder() / "layout") << left << " " << right << " " << console << " " << width << " " << height << "\n"; }

Context::Context(Registry& registry, std::function<void()> wake) : catalog(registry), worker_(registry, std::move(wake)) {
  choices = initialChoices(catalog.ids("solver"));
  history.begin(choices);
  layout.load();
  results = worker_.results();
}

void Context::refresh() {
  const auto old = results;
  results = worker_.results();
  activity = worker_.activity();
  for (LogLine& line : worker_.takeLog()) {
    if (line.kind == LogLine::Kind::error) message = line.text;
    // What moves warns of the same at every step: the last one stays.
    const bool isAgain = line.kind == LogLine::Kind::warning && !log.empty() && log.back().kind == line.kind && log.back().text.substr(0, kSameWarning) == line.text.substr(0, kSameWarning);
    if (isAgain) log.back() = std::move(line);
    else log.push_back(std::move(line));
  }
  if (log.size() > 2000) log.erase(log.begin(), log.begin() + std::ptrdiff_t(log.size() - 2000));
  {
    const std::lock_guard lock(inbox_->mutex);
    if (inbox_->springs && picked) picked->springs = std::move(*inbox_->springs), picked->isKnown = true;
    inbox_->springs.reset();
    if (inbox_->worths) worths = std::move(*inbox_->worths);
    inbox_->worths.reset();
    if (inbox_->study) study = std::exchange(inbox_->study, std::nullopt);
    if (inbox_->choices) {
      choices = std::move(*inbox_->choices);
      inbox_->choices.reset();
      changed(false);
    }
  }
  if (results->plan.value != old->plan.value) planFacts = results->planValue() ? results->planValue()->facts() : std::vector<Fact>{};
  if (results->motion.value != old->motion.value) motionFacts = results->motionValue() ? results->motionValue()->facts() : std::vector<Fact>{};
  // A picked point keeps its springs up to date; another scene has other points.
  if (results->scene.value != old->scene.value) worths.clear();
  if (results->scene.value != old->scene.value || results->plan.value != old->plan.value) study.reset();
  if (picked && results->motion.value != old->motion.value) {
    const Motion* motion = results->motionValue();
    if (!motion || std::size_t(picked->point) >= motion->outer.size()) picked.reset();
    else if (!results->isLive) pickPoint(picked->point);
  }
}

void Context::changed(bool isDragging) {
  message.clear();
  notice.clear();
  if (!isDragging) history.keep(choices);
  worker_.want(choices, isDragging);
}

void Context::undo() {
  if (!history.canUndo()) return;
  choices = history.undo();
  worker_.want(choices, false);
}

void Context::redo() {
  if (!history.canRedo()) return;
  choices = history.redo();
  worker_.want(choices, false);
}

void Context::open(const std::string& given) {
  std::string path = given;
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  const std::string ending = fs::path(path).extension().string();
  if (!fs::exists(path)) {
    message = "There is nothing at " + path;
    return;
  }
  recent.add(path);
  if (ending == ".lua") {
    worker_.run("script", [inbox = inbox_, now = choices, path](Pipeline& pipeline) {
      Choices made = pipeline.openedScript(now, path);
      const std::lock_guard lock(inbox->mutex);
      inbox->choices = std::move(made);
    });
    return;
  }
  if (ending == ".csv") {
    tab = Tab::compare;
    worker_.run("landmarks", [inbox = inbox_, made = choices, path](Pipeline& pipeline) mutable {
      std::tie(made.ctLandmarks, made.scanLandmarks) = pipeline.landmarksIn(path);
      const std::lock_guard lock(inbox->mutex);
      inbox->choices = std::move(made);
    });
    return;
  }
  for (const char* surface : {".ply", ".stl", ".obj", ".vtk", ".vtp", ".txt"}) {
    if (ending != surface) continue;
    choices.scan.settings = {{"path", path}};
    choices.scanLandmarks = {};
    tab = Tab::compare;
    changed(false);
    return;
  }
  const bool isResult = fs::exists(path + "/before.ply") && fs::exists(path + "/after.ply");
  const SettingValue* present = find(choices.loader.settings, "path");
  if (!present || *present != SettingValue(path)) choices.scan.settings.clear(), choices.scanLandmarks = {};
  choices.source = isResult ? Source::result : Source::dicom;
  choices.loader = {isResult ? "" : "loader.dicom", {{"path", path}}};
  choices.ctLandmarks = {};
  choices.corrections.clear();
  picked.reset();
  changed(false);
}

void Context::openPhantom() {
  if (choices.loader.id != "loader.phantom") choices.loader = {"loader.phantom", {{"matrix", 256.0}}};
  choices.source = Source::phantom;
  choices.scan.settings.clear();
  choices.ctLandmarks = choices.scanLandmarks = {};
  choices.corrections.clear();
  picked.reset();
  changed(false);
}

void Context::pickPoint(int point) {
  if (!picked || picked->point != point) picked = PickedPoint{point, {}, false};
  worker_.run("springs", [inbox = inbox_, point](Pipeline& pipeline) {
    auto springs = pipeline.springsAt(point);
    const std::lock_guard lock(inbox->mutex);
    inbox->springs = std::move(springs);
  });
}

void Context::studyScene() {
  worker_.run("studying accuracy", [this, inbox = inbox_](Pipeline& pipeline) {
    auto made = pipeline.study([this](double fraction, const std::string& what) { worker_.progress("accuracy", fraction, what); });
    const std::lock_guard lock(inbox->mutex);
    inbox->study = std::move(made);
  });
}

std::string Context::outPath(const std::string& name, bool isNew) const {
  std::error_code ignored;   // what is written there tells
  fs::create_directories(outFolder, ignored);
  const fs::path whole = fs::path(outFolder) / name;
  fs::path path = whole;
  for (int i = 2; isNew && fs::exists(path); ++i) path.replace_filename(whole.stem().string() + "_" + std::to_string(i) + whole.extension().string());
  return path.string();
}

void Context::measureEffects() {
  worker_.run("measuring effects", [this, inbox = inbox_](Pipeline& pipeline) {
    auto measured = pipeline.measureEffects([this](double fraction, const std::string& what) { worker_.progress("effects", fraction, what); });
    const std::lock_guard lock(inbox->mutex);
    inbox->worths = std::move(measured);
  });
}

}  // namespace pectora::view
