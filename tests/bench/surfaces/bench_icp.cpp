#include "tests/bench/surfaces/figures.h"

#include "plugins/common/surface/point_normals.h"
#include "plugins/register/icp/icp.h"

using namespace pectora;
using namespace pectora::bench;

static void icpPectora(benchmark::State& state) {
  const int n = int(state.range(0));
  const Mesh fixed = reference(n);
  double squares = 0;
  unsigned seed = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const Mesh moving = displaced(n, 0.2, ++seed);
    state.ResumeTiming();
    const double error = targetError(alignSurface({moving.points, pointNormals(moving)}, fixed, nullptr, {}, [](double) {}).map);
    squares += error * error;
  }
  state.counters["target_error_rms_mm"] = std::sqrt(squares / seed);
}
BENCHMARK(icpPectora)->Arg(317)->Arg(1001)->Unit(benchmark::kSecond)->MeasureProcessCPUTime()->UseRealTime()->Iterations(kSeeds);
