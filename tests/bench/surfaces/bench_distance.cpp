#include "tests/bench/surfaces/figures.h"

#include "plugins/common/surface/surface_tree.h"

using namespace pectora;
using namespace pectora::bench;

static void distancePectora(benchmark::State& state) {
  const int n = int(state.range(0));
  const Mesh fixed = reference(n), sample = compared(n);
  std::vector<SurfaceHit> hits;
  for (auto _ : state) hits = SurfaceTree(fixed).closest(sample.points, [](double) {});
  std::vector<double> distances;
  for (const SurfaceHit& hit : hits) distances.push_back(hit.distance);
  countDistances(state, distances, n);
}
BENCHMARK(distancePectora)->Arg(317)->Arg(1001)->Unit(benchmark::kSecond)->MeasureProcessCPUTime()->UseRealTime();
