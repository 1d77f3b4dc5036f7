// The bar moves by 2 mm from a solved state: time and force evaluations until no point is farther than 0.1 mm from rest, on the
// paper's lattice with a free pleura, 2 mm between points. "error_mm" is the largest distance of the last skin and pleura from the same wall
// solved to 1e-8; "forces_of_time" the time over that of one force evaluation in the same run.
#include "tests/plugins/solver/multigrid/walls.h"

#include "kernel/physics/workers.h"

#include <benchmark/benchmark.h>
#include <malloc.h>

#include <chrono>
#include <map>

namespace {
using namespace pectora;

// A wall, and its solved state before the ticks; made once a size.
struct Solved {
  System system;
  Solution before;

  explicit Solved(int side) : system(fineWall(side)) {
    QuietHost host;
    before = multigrid(system, 1e-8, 0)->solve(bump(system, 28), nullptr, host);
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

double largestError(const System& system, const NodeVectors& found, const NodeVectors& exact) {
  double error = 0;
  for (std::size_t i = 0; i < system.freeNodes; ++i) error = std::max(error, distance(found[i], exact[i]));
  return error;
}

// Up and down again between 24 and 32 mm, each time from where the last movement ended.
void tick(benchmark::State& state) {
  setThreads(int(state.range(1)));
  const Solved& solved = Solved::of(int(state.range(0)));
  const System& system = solved.system;
  const double one = secondsOfOneEvaluation(system);
  QuietHost host;
  const auto session = multigrid(system, 1e-12, 0.1);
  std::map<double, Drive> drives;
  for (double height = 24; height <= 32; height += 2) drives[height] = bump(system, height);
  double height = 28, step = 2, seconds = 0, forces = 0;
  const auto move = [&](const NodeVectors& start) {
    if (height >= 32 || height <= 24) step = -step;
    height += step;
    return session->solve(drives.at(height), &start, host);
  };
  Solution found = move(solved.before.positions);   // prepares the coarse grids
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    found = move(found.positions);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    forces += found.forceEvaluations;
  }
  const Solution exact = multigrid(system, 1e-8)->solve(drives.at(height), &found.positions, host);
  state.counters["error_mm"] = largestError(system, found.positions, exact.positions);
  state.counters["force_evaluations"] = forces / double(state.iterations());
  state.counters["forces_of_time"] = seconds / double(state.iterations()) / one;
  state.counters["reference_residual"] = exact.relativeResidual;
}

void fromRest(benchmark::State& state) {
  setThreads(int(state.range(1)));
  const Solved& solved = Solved::of(int(state.range(0)));
  const double one = secondsOfOneEvaluation(solved.system);
  QuietHost host;
  const auto session = multigrid(solved.system, 1e-12, 0.1);
  const Drive drive = bump(solved.system, 28);
  Solution found = session->solve(drive, nullptr, host);   // prepares the coarse grids
  double seconds = 0;
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    found = session->solve(drive, nullptr, host);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  state.counters["error_mm"] = largestError(solved.system, found.positions, solved.before.positions);
  state.counters["force_evaluations"] = found.forceEvaluations;
  state.counters["forces_of_time"] = seconds / double(state.iterations()) / one;
  state.counters["reference_residual"] = solved.before.relativeResidual;
}

// A slider: the skin becomes 20 % stiffer, or softer again. Counted is all of it, from the new constants to the new rest: points copied, new
// terms, a session that takes over what the last one prepared, and the solve from where the wall was.
void stiffnessSlider(benchmark::State& state) {
  setThreads(2);
  const int side = int(state.range(0));
  QuietHost host;
  const System points = fineGrid(side);
  const auto wall = [&](double skin) {
    auto made = std::make_unique<System>();
    made->rows = points.rows, made->columns = points.columns, made->freeNodes = points.freeNodes;
    made->rest = points.rest, made->mass = points.mass;
    setTerms(*made, 2, skin);
    return made;
  };
  double skin = 1;
  auto system = wall(skin);
  auto session = multigrid(*system, 1e-12, 0.1);
  const Drive drive = bump(*system, 28);
  Solution found = session->solve(drive, &Solved::of(side).before.positions, host);
  for (auto _ : state) {
    skin = skin == 1 ? 1.2 : 1;
    auto next = wall(skin);
    auto nextSession = multigrid(*next, 1e-12, 0.1);
    nextSession->takeOver(*session);
    session = std::move(nextSession), system = std::move(next);
    found = session->solve(drive, &found.positions, host);
  }
  const Solution exact = multigrid(*system, 1e-8, 0)->solve(drive, &found.positions, host);
  state.counters["error_mm"] = largestError(*system, found.positions, exact.positions);
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

BENCHMARK(tick)->ArgsProduct({{100, 224, 447}, {1, 2}})->ArgNames({"side", "threads"})->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(stiffnessSlider)->Arg(224)->ArgNames({"side"})->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(memory)->Arg(224)->Arg(447)->ArgNames({"side"})->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(fromRest)->ArgsProduct({{100, 224}, {2}})->ArgNames({"side", "threads"})->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
