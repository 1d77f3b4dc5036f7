// The bar moves by 2 mm from a solved state: time and force evaluations until no point is farther than 0.1 mm from rest, on the
// paper's lattice with a free pleura, 2 mm between points. "error_mm" is the largest distance from the same wall solved to
// 1e-8; "forces_of_time" the time over that of one force evaluation in the same run.
#include "tests/plugins/solver/multigrid/walls.h"

#include "kernel/physics/workers.h"

#include <benchmark/benchmark.h>
#include <malloc.h>

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

double heapBytes() {
  const auto info = mallinfo2();
  return double(info.uordblks + info.hblkhd);
}

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

// A slider: the skin becomes 20 % stiffer, or softer again. Counted is all of it, from the new constants to the new rest: terms, a session that
// takes over what the last one prepared, and the solve from where the wall was.
void stiffnessSlider(benchmark::State& state) {
  setThreads(2);
  const int side = int(state.range(0));
  QuietHost host;
  double skin = 1;
  auto system = std::make_unique<System>(fineWall(side, 2, skin));
  auto session = multigrid(*system, 1e-12, 0.1);
  const Drive drive = bump(*system, 28);
  Solution found = session->solve(drive, &Solved::of(side).before.positions, host);
  for (auto _ : state) {
    skin = skin == 1 ? 1.2 : 1;
    auto next = std::make_unique<System>(fineWall(side, 2, skin));
    auto nextSession = multigrid(*next, 1e-12, 0.1);
    nextSession->takeOver(*session);
    session = std::move(nextSession), system = std::move(next);
    found = session->solve(drive, &found.positions, host);
  }
  const Solution exact = multigrid(*system, 1e-8, 0)->solve(drive, &found.positions, host);
  double error = 0;
  for (std::size_t i = 0; i < system->freeNodes; ++i) error = std::max(error, distance(found.positions[i], exact.positions[i]));
  state.counters["error_mm"] = error;
  state.counters["force_evaluations"] = found.forceEvaluations;
}

// Heap of the lattice with its attachments and anchors, and of the solver's session after a tick.
void memory(benchmark::State& state) {
  setThreads(2);
  const int side = int(state.range(0));
  const double points = double(side) * side;
  const Solved& solved = Solved::of(side);
  QuietHost host;
  double lattice = 0, session = 0;
  for (auto _ : state) {
    const double none = heapBytes();
    const System system = fineWall(side);
    lattice = heapBytes() - none;
    const auto solver = multigrid(system, 1e-12, 0.1);
    { const Solution found = solver->solve(bump(system, 30), &solved.before.positions, host); }
    session = heapBytes() - none - lattice;
  }
  state.counters["lattice_bytes_a_point"] = lattice / points;
  state.counters["solver_bytes_a_point"] = session / points;
}
void fromRest(benchmark::State& state) { solve(state, false); }
BENCHMARK(tick)->ArgsProduct({{100, 224, 447}, {1, 2}})->ArgNames({"side", "threads"})->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(stiffnessSlider)->Arg(224)->ArgNames({"side"})->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(memory)->Arg(224)->Arg(447)->ArgNames({"side"})->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(fromRest)->ArgsProduct({{100, 224}, {2}})->ArgNames({"side", "threads"})->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
