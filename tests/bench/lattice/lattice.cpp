// One evaluation of the lattice's forces, for the 37 springs a skin point of the paper's five kinds, in ns per spring; and what this
// machine allows at the best, measured beside it: no evaluation is faster than its arithmetic from registers, nor than reading all
// positions and adding to all forces once. "of_roofline" is the time over the longer of these two.
#include "kernel/physics/calibration.h"
#include "kernel/physics/rows.h"
#include "kernel/physics/springs.h"
#include "kernel/physics/workers.h"

#include <benchmark/benchmark.h>

#include <chrono>
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

constexpr int kLanes = 64;

// The least time of `count` springs in single precision: the operations of one, with a square root and a division, on numbers that stay
// in the first cache.
PECTORA_WIDE void arithmetic(const float* a, float* b, int repeats) {
  for (int n = 0; n < repeats; ++n)
#pragma GCC ivdep
    for (int i = 0; i < kLanes; ++i) {
      const float ux = a[i], uy = a[i + 1], uz = a[i + 2], x0 = b[i], y0 = a[i + 3], z0 = a[i + 4];
      const float x = x0 + ux, y = y0 + uy, z = z0 + uz;
      const float squared = x * x + y * y + z * z, squared0 = x0 * x0 + y0 * y0 + z0 * z0;
      const float growth = ux * (x + x0) + uy * (y + y0) + uz * (z + z0), product = std::sqrt(squared * squared0);
      const float below = squared + product, sum = squared + squared0 + 2 * product, share = growth / (below * sum);
      const float scale = share * sum, twice = share * growth * below;
      b[i] = scale * x + scale * y + scale * z + twice;
    }
}
double secondsOfArithmetic(std::size_t count) {
  std::vector<float> a(kLanes + 8, 1.5f), b(kLanes + 8, 2.5f);
  const int repeats = int(count / kLanes);
  double best = INFINITY;
  for (int n = 0; n < 20; ++n) {
    const auto start = std::chrono::steady_clock::now();
    arithmetic(a.data(), b.data(), repeats);
    benchmark::DoNotOptimize(b.data());
    benchmark::ClobberMemory();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

// The least time to read the positions of all nodes and to add to their forces.
double secondsOfMemory(const NodeVectors& x, NodeVectors& gradient) {
  double best = INFINITY;
  for (int n = 0; n < 20; ++n) {
    const auto start = std::chrono::steady_clock::now();
    for (auto [in, out] : {std::pair{&x.x, &gradient.x}, {&x.y, &gradient.y}, {&x.z, &gradient.z}})
      for (std::size_t i = 0; i < in->size(); ++i) (*out)[i] += (*in)[i];
    benchmark::ClobberMemory();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

// Arguments: points of the side, threads, whether in single precision.
void evaluate(benchmark::State& state) {
  setThreads(int(state.range(1)));
  const System system = wall(int(state.range(0)));
  const auto term = makeLatticeTerm("lattice", system, stencil());
  const NodeVectors x = waved(system);
  NodeVectors gradient(x.size());
  double largest = 0, best = INFINITY;
  const double roofline = std::max(secondsOfArithmetic(springCount(int(state.range(0)))) / double(state.range(1)), secondsOfMemory(x, gradient));
  for (auto _ : state) {
    gradient.clear();
    const auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(state.range(2) ? term->evaluateRoughly(x, gradient, largest) : term->evaluate(x, gradient, largest));
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  if (state.range(2)) state.counters["of_roofline"] = best / roofline;
  state.counters["ns_per_spring"] =
      benchmark::Counter(double(springCount(int(state.range(0)))) * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(evaluate)->ArgsProduct({{40, 100, 224, 447}, {1, 2}, {0, 1}})->ArgNames({"side", "threads", "rough"})->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
