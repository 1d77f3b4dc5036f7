#include "tests/bench/surfaces/figures.h"

using namespace pectora;
using namespace pectora::bench;

static void distancePectora(benchmark::State& state) {
  const int n = int(state.range(0));
  const Mesh fixed = reference(n), sample = compared(n);
  std::vector<double> distances;
  for (auto _ : state) distances = ourDistances(fixed, sample);
  countDistances(state, distances, n);
}
BENCHMARK(distancePectora)->Arg(317)->Arg(1001)->Unit(benchmark::kSecond)->MeasureProcessCPUTime()->UseRealTime();
