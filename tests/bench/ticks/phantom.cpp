// The bar moves by 2 mm at a time, up and down between 16 and 28 mm, in the wall of the built-in phantom: what a user of the tool window
// waits for, without the window.
#include "kernel/host/registry.h"
#include "kernel/host/runner.h"
#include "kernel/host/warm.h"
#include "tests/kernel/host/quiet_host.h"

#include <benchmark/benchmark.h>

#include <atomic>
#include <map>

namespace {
using namespace pectora;

/// A phantom's rib cage, and scenes and plans on it.
class Patient {
 public:
  static Patient& one() {
    static Patient patient;
    return patient;
  }
  Registry registry{{PECTORA_PLUGINS}};

  /// Slack skin gives way, as in scripts/correction.lua.
  std::shared_ptr<const Scene> scene(double spacing, bool withContact) {
    const Settings skin{{"compression", 0.02}};
    std::vector<Handle> effects;
    for (const char* id : {"effect.stretch", "effect.shear", "effect.bend"}) effects.push_back(run(id, skin, {})[0]);
    for (const char* id : {"effect.direct", "effect.cross", "effect.attachment"}) effects.push_back(run(id, {}, {})[0]);
    if (withContact) effects.push_back(run("effect.rib_contact", {}, {})[0]);
    return std::dynamic_pointer_cast<const Scene>(run("model.two_layer", {{"spacing", spacing}}, {{cage_}, effects})[0].value);
  }
  std::shared_ptr<const Plan> plan(double lift) {
    return std::dynamic_pointer_cast<const Plan>(run("planner.nuss", {{"lift", lift}}, {{cage_}})[0].value);
  }
  std::unique_ptr<WarmSolve> solve(std::shared_ptr<const Scene> scene, const std::string& id, const Settings& settings, Host& host) {
    auto solver = registry.open(id).descriptor->makeSolver();
    applySettings(settings, [&](Visitor& v) { solver->describe(v); });
    return std::make_unique<WarmSolve>(std::move(scene), id, std::move(solver), registry, host);
  }

 private:
  Patient() {
    const auto phantom = run("loader.phantom", {{"matrix", 256.0}}, {});
    const auto anatomy = run("segmenter.thorax", {}, {{phantom[0]}});
    cage_ = run("splines.cartilage", {}, {{anatomy[0]}, {phantom[0]}})[0];
  }
  std::vector<Handle> run(const std::string& id, const Settings& settings, Runner::PortInputs inputs) {
    inputs.resize(runner_.ports(id).size());
    return runner_.run(id, settings, inputs);
  }

  Messages messages_;
  std::atomic<bool> cancel_{false};
  Runner runner_{registry, messages_, cancel_};
  Handle cage_;
};

void phantomTick(benchmark::State& state) {
  Patient& patient = Patient::one();
  QuietHost host;
  const auto warm = patient.solve(patient.scene(double(state.range(0)) / 100, state.range(1)), "solver.multigrid", {{"accuracy", 0.1}}, host);
  warm->solve(*patient.plan(20), host);
  double lift = 20, step = 2, forces = 0, iterations = 0;
  std::shared_ptr<const Motion> motion;
  for (auto _ : state) {
    if (lift >= 28 || lift <= 16) step = -step;
    lift += step;
    motion = warm->solve(*patient.plan(lift), host);
    if (motion->status != SolveStatus::converged) state.SkipWithError(motion->message.c_str());
    forces += motion->forceEvaluations, iterations += motion->iterations;
  }
  // How far the last skin is from rest.
  const auto exact = patient.solve(warm->scene(), "solver.multigrid", {{"tolerance", 1e-8}, {"max_iterations", 20000.0}}, host);
  exact->startFrom(*motion);
  const auto rest = exact->solve(*patient.plan(lift), host);
  double largest = 0, squares = 0;
  for (std::size_t i = 0; i < rest->outer.size(); ++i) {
    const double error = distance(rest->outer[i], motion->outer[i]);
    largest = std::max(largest, error), squares += error * error;
  }
  state.counters["error_mm"] = largest;
  state.counters["rms_error_mm"] = std::sqrt(squares / double(rest->outer.size()));
  state.counters["reference_residual"] = rest->relativeResidual;
  state.counters["points"] = double(warm->compiled().system->points());
  state.counters["force_evaluations"] = forces / double(state.iterations());
  state.counters["iterations"] = iterations / double(state.iterations());
}
BENCHMARK(phantomTick)->ArgsProduct({{1000, 400, 177}, {0, 1}})->ArgNames({"hundredths_mm", "contact"})->UseRealTime()->Unit(benchmark::kMillisecond)->Iterations(24);

}  // namespace
