// One evaluation of the lattice's forces, for the 37 springs a skin point of the paper's five kinds, in ns per spring.
#include "kernel/physics/calibration.h"
#include "kernel/physics/springs.h"
#include "kernel/physics/workers.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace {
using namespace pectora;

// A square wall, slightly waved so that no spring is at rest.
System wall(int side) {
  System system;
  system.rows = system.columns = side;
  system.freeNodes = 2 * std::size_t(side) * side;
  system.rest = NodeVectors(system.freeNodes);
  for (std::size_t i = 0; i < system.freeNodes; ++i) {
    const std::size_t point = i % (system.freeNodes / 2);
    system.rest.set(i, {8.0 * double(point % side), i < system.freeNodes / 2 ? -20.0 : 0.0, 8.0 * double(point / side)});
  }
  return system;
}

std::vector<StencilSpring> stencil() {
  std::vector<StencilSpring> springs;
  for (int r = -2; r <= 2; ++r)
    for (int c = -2; c <= 2; ++c) springs.push_back({Layer::outer, Layer::inner, r, c, 0.02});
  for (const auto& [r, c] : {std::pair{1, 0}, {0, 1}, {1, 1}, {-1, 1}}) springs.push_back({Layer::outer, Layer::outer, r, c, 0.2});
  for (const auto& [r, c] : bendOffsets()) springs.push_back({Layer::outer, Layer::outer, r, c, 0.05});
  return springs;
}

std::size_t springCount(int side) {
  std::size_t count = 0;
  for (const StencilSpring& s : stencil()) count += std::size_t(side - std::abs(s.rows)) * (side - std::abs(s.columns));
  return count;
}

NodeVectors waved(const System& system) {
  NodeVectors x = system.rest;
  for (std::size_t i = 0; i < x.size(); ++i) x.y[i] -= 5 * std::sin(0.03 * x.x[i]) * std::cos(0.05 * x.z[i]);
  return x;
}

// Arguments: points of the side, threads.
void evaluate(benchmark::State& state) {
  setThreads(int(state.range(1)));
  const System system = wall(int(state.range(0)));
  const auto term = makeLatticeTerm("lattice", system, stencil());
  const NodeVectors x = waved(system);
  NodeVectors gradient(x.size());
  double largest = 0;
  for (auto _ : state) {
    gradient.clear();
    benchmark::DoNotOptimize(state.range(2) ? term->evaluateRoughly(x, gradient, largest) : term->evaluate(x, gradient, largest));
  }
  state.counters["ns_per_spring"] =
      benchmark::Counter(double(springCount(int(state.range(0)))) * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(evaluate)->ArgsProduct({{40, 100, 224, 447}, {1, 2}, {0, 1}})->ArgNames({"side", "threads", "rough"})->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
