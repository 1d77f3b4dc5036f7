// The solid wall of about 20 k nodes: its parts, and the whole solution against CalculiX on the same mesh and lift in one run.
#include "tests/plugins/effect/common/slab.h"

#include "kernel/physics/workers.h"

#include <benchmark/benchmark.h>

#include <chrono>

namespace {
using namespace pectora;

constexpr int kCells = 56, kThrough = 5;   // 57 x 57 x 6 nodes
constexpr double kLift = 15;

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

NodeVectors bent(const Slab& slab) {
  return sum(slab.system.rest, 1, noise(slab.system.rest.size(), 0.3, 1));
}

// Argument: threads.
void evaluate(benchmark::State& state) {
  setThreads(int(state.range(0)));
  const Slab slab(kCells, kThrough, 0.45, kLift);
  const NodeVectors x = bent(slab);
  NodeVectors gradient(x.size());
  double largest = 0;
  for (auto _ : state) benchmark::DoNotOptimize(slab.system.evaluate(x, gradient, largest));
}
BENCHMARK(evaluate)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

// Arguments: threads, projected.
void linearise(benchmark::State& state) {
  setThreads(int(state.range(0)));
  const Slab slab(kCells, kThrough, 0.45, kLift);
  const NodeVectors x = bent(slab);
  const auto hessian = makeHessian(slab.system);
  for (auto _ : state) hessian->linearise(x, state.range(1) != 0);
}
BENCHMARK(linearise)->Args({1, 0})->Args({1, 1})->Args({2, 1})->ArgNames({"threads", "projected"})->UseRealTime()->Unit(benchmark::kMillisecond);

void multiply(benchmark::State& state) {
  setThreads(int(state.range(0)));
  const Slab slab(kCells, kThrough, 0.45, kLift);
  const auto hessian = makeHessian(slab.system);
  hessian->linearise(slab.system.rest, true);
  const NodeVectors v = noise(slab.system.rest.size(), 1, 2);
  NodeVectors y(v.size());
  for (auto _ : state) hessian->multiply(v, y);
}
BENCHMARK(multiply)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

// Argument: 100 times Poisson's ratio. CalculiX first, then Newton's method here to three tolerances.
void againstCalculix(benchmark::State& state) {
  if (std::string(PECTORA_CCX).empty()) {
    state.SkipWithError("CalculiX (ccx) is not installed");
    return;
  }
  setThreads(2);
  const Slab slab(kCells, kThrough, double(state.range(0)) / 100, kLift);
  for (auto _ : state) {
    auto start = std::chrono::steady_clock::now();
    const std::vector<Vec3> theirs = solveByCalculix(PECTORA_CCX, slab, "C3D8I", true, std::filesystem::temp_directory_path() / "pectora_bench_ccx");
    const double calculix = secondsSince(start);
    state.counters["calculix_s"] = calculix;
    for (const auto& [name, tolerance] : {std::pair{"1e-3", 1e-3}, {"1e-4", 1e-4}, {"1e-6", 1e-6}}) {
      start = std::chrono::steady_clock::now();
      const Slab fresh(kCells, kThrough, slab.poissonsRatio, kLift);
      const std::vector<Vec3> ours = solveHere(fresh, tolerance);
      const double seconds = secondsSince(start);
      double squares = 0, largest = 0;
      for (std::size_t i = 0; i < ours.size(); ++i) {
        const double d = distance(ours[i], theirs[i]);
        squares += d * d;
        largest = std::max(largest, d);
      }
      const std::string at = std::string("_") + name;
      state.counters["seconds" + at] = seconds;
      state.counters["ratio" + at] = calculix / seconds;
      state.counters["rms_mm" + at] = std::sqrt(squares / double(ours.size()));
      state.counters["max_mm" + at] = largest;
    }
  }
}
BENCHMARK(againstCalculix)->Arg(45)->Arg(49)->ArgName("nu_percent")->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
