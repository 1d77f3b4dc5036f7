// The bar moves by 2 mm from a solved state: time and force evaluations until no point is farther than 0.1 mm from rest, on the
// paper's lattice with a free pleura, 2 mm between points. "error_mm" is the largest distance from the same wall solved to
// 1e-8; "forces_of_time" the time over that of one force evaluation in the same run.
#include "tests/plugins/solver/multigrid/walls.h"

#include "kernel/physics/workers.h"

#include <benchmark/benchmark.h>

#include <chrono>
#include <map>

namespace {
using namespace pectora;

// A wall with its solved states before and after the tick; made once a size.
struct Solved {
  System system;
  Solution before, after;

  explicit Solved(int side) : system(fineWall(side)) {
    QuietHost host;
    before = multigrid(system, 1e-8, 0)->solve(bump(system, 28), nullptr, host);
    after = multigrid(system, 1e-8, 0)->solve(bump(system, 30), &before.positions, host);
  }
  static const Solved& of(int side) {
    static std::map<int, std::unique_ptr<Solved>> all;
    auto& found = all[side];
    if (!found) found = std::make_unique<Solved>(side);
    return *found;
  }
};

double secondsOfOneEvaluation(const System& system) {
  NodeVectors gradient(system.rest.size());
  double best = INFINITY, largest = 0;
  for (int i = 0; i < 10; ++i) {
    const auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(system.evaluate(system.rest, gradient, largest));
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

void solve(benchmark::State& state, bool isTick) {
  setThreads(int(state.range(1)));
  const Solved& solved = Solved::of(int(state.range(0)));
  const System& system = solved.system;
  const double one = secondsOfOneEvaluation(system);
  QuietHost host;
  const auto session = multigrid(system, 1e-12, 0.1);
  const Drive drive = bump(system, isTick ? 30 : 28);
  const Solution& exact = isTick ? solved.after : solved.before;
  Solution found = session->solve(drive, isTick ? &solved.before.positions : nullptr, host);   // prepares the coarse grids
  const auto start = std::chrono::steady_clock::now();
  for (auto _ : state) found = session->solve(drive, isTick ? &solved.before.positions : nullptr, host);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / double(state.iterations());
  double error = 0;
  for (std::size_t i = 0; i < system.freeNodes; ++i) error = std::max(error, distance(found.positions[i], exact.positions[i]));
  state.counters["error_mm"] = error;
  state.counters["force_evaluations"] = found.forceEvaluations;
  state.counters["forces_of_time"] = seconds / one;
  state.counters["reference_residual"] = exact.relativeResidual;
}

void tick(benchmark::State& state) { solve(state, true); }
void fromRest(benchmark::State& state) { solve(state, false); }
BENCHMARK(tick)->ArgsProduct({{100, 224, 447}, {1, 2}})->ArgNames({"side", "threads"})->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(fromRest)->ArgsProduct({{100, 224}, {2}})->ArgNames({"side", "threads"})->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
