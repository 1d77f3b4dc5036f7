#include "kernel/host/runner.h"

#include "kernel/host/hash.h"
#include "kernel/host/warm.h"
#include "kernel/stage/effect.h"
#include "kernel/stage/solver.h"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <optional>

namespace pectora {
namespace {

const std::vector<Port> kSolverPorts{{"scene", {Scene::kName}}, {"plan", {Plan::kName}}, {"start", {Motion::kName}, true}};
const std::vector<Port> kNoPorts;

const std::vector<Port>& portsOf(const Descriptor& d) {
  return d.makeSolver ? kSolverPorts : d.makeStage ? d.inputs : kNoPorts;
}

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Of all threads of this process.
double cpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

double heapMegabytes() {
  const auto info = mallinfo2();
  return double(info.uordblks + info.hblkhd) / 1048576;
}

double peakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024;
}

// What a stage sees of the program; collects its warnings for the record. Stages may warn from several threads.
class StageHost final : public Host {
 public:
  StageHost(std::string stage, std::string folder, Messages& messages, const std::atomic<bool>& cancel)
      : stage_(std::move(stage)), folder_(std::move(folder)), messages_(messages), cancel_(cancel) {}

  void progress(double fraction, const std::string& what) override { messages_.progress(stage_, fraction, what); }
  bool cancelled() const override { return cancel_.load(std::memory_order_relaxed); }
  void warn(const std::string& message) override {
    const std::lock_guard lock(mutex_);
    warnings_.push_back(message);
    messages_.warn(stage_, message);
  }
  void info(const std::string& message) override { messages_.info(stage_, message); }
  void preview(const NodeVectors& positions) override { messages_.preview(positions); }
  std::string pluginFolder() const override { return folder_; }
  std::vector<std::string> takeWarnings() { return std::move(warnings_); }

 private:
  std::string stage_, folder_;
  Messages& messages_;
  const std::atomic<bool>& cancel_;
  std::mutex mutex_;
  std::vector<std::string> warnings_;
};

// Settings as the record shows them: read paths as hashes, written paths not at all.
std::vector<std::pair<std::string, std::string>> recordSettings(const std::vector<Parameter>& parameters) {
  std::vector<std::pair<std::string, std::string>> settings;
  for (const Parameter& p : parameters) {
    if (p.role == TextRole::outputPath) continue;
    std::string text = canonicalText(p.value);
    if (p.role == TextRole::inputPath && !text.empty()) {
      std::vector<std::string> paths{text};
      if (const auto* list = std::get_if<std::vector<std::string>>(&p.value)) paths = *list;
      text.clear();
      for (const std::string& path : paths) {
        try {
          text += (text.empty() ? "xxh128:" : ",xxh128:") + hashPath(path);
        } catch (Error& error) {
          throw error.of(p.name);
        }
      }
    }
    settings.emplace_back(p.name, std::move(text));
  }
  return settings;
}

std::string cacheKey(const Plugin& plugin, const Record& record) {
  std::string text = plugin.descriptor->id + "\n" + plugin.fileHash + "\n";
  for (const auto& [name, value] : record.settings) text += name + "=" + value + "\n";
  for (const auto& [name, input] : record.inputs) text += name + "<" + input->key + "\n";
  return hashText(text);
}

}  // namespace

Runner::Runner(Registry& registry, Messages& messages, std::atomic<bool>& cancel)
    : registry_(registry), messages_(messages), cancel_(cancel) {}

const std::vector<Port>& Runner::ports(const std::string& id) { return portsOf(*registry_.open(id).descriptor); }

std::vector<Parameter> Runner::parametersOf(const std::string& id) {
  const Descriptor& d = *registry_.open(id).descriptor;
  if (d.makeStage) {
    const auto stage = d.makeStage();
    return parameters([&](Visitor& v) { stage->describe(v); });
  }
  if (d.makeEffect) {
    const auto effect = d.makeEffect();
    return parameters([&](Visitor& v) { effect->describe(v); });
  }
  const auto solver = d.makeSolver();
  std::vector<Parameter> found = parameters([&](Visitor& v) { solver->describe(v); });
  found.push_back({kAcceptUnconverged, "flag", "", {}, {}, {}, TextRole::plain,
                   "pass the result on even if it did not converge; its status says so", false});
  return found;
}

void Runner::checkInputs(const Plugin& plugin, const PortInputs& inputs) const {
  const std::vector<Port>& ports = portsOf(*plugin.descriptor);
  for (std::size_t i = 0; i < ports.size(); ++i) {
    const Port& port = ports[i];
    std::string kinds;
    for (const char* kind : port.kinds) kinds += (kinds.empty() ? "" : " or ") + std::string(kind);
    if (inputs[i].empty() && !port.isOptional && !port.isList)
      throw Error("this input is missing").of(port.name).allowed("a value of kind " + kinds);
    for (const Handle& handle : inputs[i]) {
      const bool fits = std::any_of(port.kinds.begin(), port.kinds.end(),
                                    [&](const char* kind) { return std::string(kind) == handle.value->kind(); });
      if (!fits)
        throw Error("wrong kind of input").of(port.name).given("a value of kind " + std::string(handle.value->kind()))
            .allowed("a value of kind " + kinds);
    }
  }
}

std::vector<Handle> Runner::fromCache(const std::string& key) {
  const auto found = std::find_if(cache_.begin(), cache_.end(), [&](const CacheEntry& e) { return e.key == key; });
  if (found == cache_.end()) return {};
  cache_.splice(cache_.begin(), cache_, found);
  return found->handles;
}

void Runner::keep(const std::string& key, const std::vector<Handle>& handles) {
  std::size_t bytes = 1 << 16;  // what small values and the record may take
  for (const Handle& handle : handles) bytes += handle.value->bytes();
  cache_.push_front({key, handles, bytes});
  std::size_t total = 0;
  for (auto entry = cache_.begin(); entry != cache_.end();) {
    total += entry->bytes;
    entry = total > cacheBudget && entry != cache_.begin() ? cache_.erase(entry) : std::next(entry);
  }
}

std::vector<Handle> Runner::run(const std::string& id, const Settings& settings, const PortInputs& inputs) {
  const Plugin& plugin = registry_.open(id);
  const Descriptor& descriptor = *plugin.descriptor;
  try {
    // Settings first, so that a wrong one is told before any work.
    bool accept = false;
    std::unique_ptr<Stage> stage;
    std::unique_ptr<Effect> effect;
    std::unique_ptr<Solver> solver;
    Describe describe;
    if (descriptor.makeStage) {
      stage = descriptor.makeStage();
      describe = [&](Visitor& v) { stage->describe(v); };
    } else if (descriptor.makeEffect) {
      effect = descriptor.makeEffect();
      describe = [&](Visitor& v) { effect->describe(v); };
    } else {
      solver = descriptor.makeSolver();
      describe = [&](Visitor& v) {
        solver->describe(v);
        v.flag(kAcceptUnconverged, accept, "");
      };
    }
    applySettings(settings, describe);
    checkInputs(plugin, inputs);
    messages_.starting(id, settings, inputs);

    // The record, but for what is known only afterwards.
    auto record = std::make_shared<Record>();
    record->stage = id;
    record->version = descriptor.version;
    record->settings = recordSettings(parameters(describe));
    const std::vector<Port>& inputPorts = portsOf(descriptor);
    for (std::size_t i = 0; i < inputPorts.size(); ++i)
      for (const Handle& handle : inputs[i]) record->inputs.emplace_back(inputPorts[i].name, handle.record);
    record->key = cacheKey(plugin, *record);

    if (effect) {
      auto call = std::make_shared<EffectCall>();
      call->id = id;
      call->settings = settings;
      return {{call, record}};
    }
    const bool cacheable = descriptor.isCacheable;
    if (cacheable && !(descriptor.makeSolver && explanations)) {
      if (std::vector<Handle> cached = fromCache(record->key); !cached.empty()) {
        for (const std::string& warning : cached.front().record->warnings) messages_.warn(id, warning);
        messages_.finished(*cached.front().record, true);
        messages_.made(cached);
        return cached;
      }
    }

    StageHost host(id, std::filesystem::path(plugin.file).parent_path().string(), messages_, cancel_);
    host.checkCancel();
    const auto start = std::chrono::steady_clock::now();
    const double cpuBefore = cpuSeconds();
    Outputs outputs;
    if (stage) {
      outputs = stage->run(Inputs(descriptor.inputs, inputs), host);
      if (outputs.size() != descriptor.outputs.size())
        throw std::logic_error(fmt::format("returned {} values instead of {}", outputs.size(), descriptor.outputs.size()));
    } else {
      outputs = {solve(plugin, std::move(solver), inputs, accept, host, *record)};
    }
    record->seconds = secondsSince(start);
    record->cpuSeconds = cpuSeconds() - cpuBefore;
    record->peakMegabytes = peakMegabytes();
    record->warnings = host.takeWarnings();
    messages_.finished(*record, false);
    std::vector<Handle> handles;
    for (auto& output : outputs) handles.push_back({std::move(output), record});
    if (cacheable) keep(record->key, handles);
    messages_.made(handles);
    return handles;
  } catch (Error& error) {
    throw error.inStage(id);
  } catch (const std::bad_alloc&) {
    throw Error("there is not enough memory", ErrorKind::runFailed).inStage(id).advise("Use fewer slices, or a coarser model");
  } catch (const Cancelled&) {
    throw;
  } catch (const Explained&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(std::string("internal error: ") + error.what(), ErrorKind::runFailed).inStage(id);
  }
}

std::shared_ptr<const Motion> Runner::solve(const Plugin& plugin, std::unique_ptr<Solver> solver, const PortInputs& inputs, bool accept,
                                            Host& host, Record& record) {
  auto scene = std::dynamic_pointer_cast<const Scene>(inputs[0].front().value);
  const auto plan = std::dynamic_pointer_cast<const Plan>(inputs[1].front().value);
  std::optional<Probe> probe;
  if (scene->effectAccuracy > 0) {
    Choice choice = chooseEffects(*scene, *plan, registry_, host);
    for (const EffectUse& use : choice.probe.effects)
      host.info(fmt::format("{} {}{}", use.id, use.isActive ? "runs" : "drops out: " + use.reason,
                            std::isnan(use.changeRms) ? "" : fmt::format(" ({:.2f} mm RMS)", use.changeRms)));
    scene = choice.scene;
    probe = std::move(choice.probe);
  }
  const double heapBefore = heapMegabytes();
  const auto begin = std::chrono::steady_clock::now();
  WarmSolve warm(scene, plugin.descriptor->id, std::move(solver), registry_, host);
  if (explanations) {
    explain(plugin, warm.compiled(), *scene, probe ? *probe : probeEffects(*scene, *plan, registry_, host));
    throw Explained();
  }
  if (!inputs[2].empty()) warm.startFrom(*std::dynamic_pointer_cast<const Motion>(inputs[2].front().value));
  warm.prepare(host);
  record.prepareSeconds = secondsSince(begin);
  const std::shared_ptr<const Motion> motion = warm.solve(*plan, host);
  record.heldMegabytes = std::max(0.0, heapMegabytes() - heapBefore);

  if (motion->invertedPrisms > 0)
    host.warn(fmt::format("{} cells between skin and pleura turned inside out, the first at row {}, column {}",
                          motion->invertedPrisms, motion->invertedAt / scene->columns, motion->invertedAt % scene->columns));
  if (motion->status == SolveStatus::converged && !motion->message.empty()) host.warn(motion->message);
  if (motion->status != SolveStatus::converged) {
    const std::string what = fmt::format("the solver {} after {} iterations, with a relative residual of {:.2g}{}{}",
                                         statusName(motion->status), motion->iterations, motion->relativeResidual,
                                         motion->message.empty() ? "" : ": ", motion->message);
    if (!accept)
      throw Error(what, ErrorKind::runFailed)
          .advise(fmt::format("Allow more iterations, a larger tolerance, or take it as it is with {} = true", kAcceptUnconverged));
    host.warn(what);
  }
  return motion;
}

void Runner::explain(const Plugin& plugin, const Compiled& compiled, const Scene& scene, const Probe& probe) {
  Explanation e;
  e.solver = plugin.descriptor->id;
  e.skinPoints = scene.points();
  e.freeNodes = compiled.system->freeNodes;
  e.anchors = scene.anchors.size();
  e.effects = probe.effects;
  e.uncertainty = probe.uncertainty;
  // The best of three evaluations of each term.
  NodeVectors gradient(compiled.system->rest.size());
  for (const auto& term : compiled.system->terms) {
    double best = INFINITY, largest = 0;
    for (int i = 0; i < 3; ++i) {
      const auto start = std::chrono::steady_clock::now();
      term->evaluate(compiled.system->rest, gradient, largest);
      best = std::min(best, 1000 * secondsSince(start));
    }
    e.termMilliseconds.emplace_back(term->name(), best);
  }
  explanations->push_back(std::move(e));
}

}  // namespace pectora
