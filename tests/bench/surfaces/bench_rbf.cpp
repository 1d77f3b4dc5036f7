// A surface from 200,000 noisy points with holes, normals estimated.
#include "tests/bench/surfaces/figures.h"

#include "plugins/scan/rbf/reconstruct.h"

using namespace pectora;
using namespace pectora::bench;

static void rbfPectora(benchmark::State& state) {
  constexpr double kNoise = 0.5;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::normal_distribution<double> noise(0, kNoise);
  std::vector<Vec3> points;
  while (points.size() < std::size_t(state.range(0))) {
    const double x = 140 * unit(random), z = 180 * unit(random);
    // Holes of 8 mm radius every 60 mm, and one of 30 mm.
    if (std::hypot(std::remainder(x, 60), std::remainder(z, 60)) < 8 || std::hypot(x - 100, z - 100) < 30) continue;
    Vec3 normal;
    const Vec3 p = chestPoint(x, z, &normal);
    points.push_back(p + normal * noise(random));
  }
  Reconstruction made;
  for (auto _ : state) made = reconstruct(points, {}, {}, [](double) {});
  double squares = 0;
  for (const Vec3& p : made.mesh.points) {
    Vec3 normal;
    const Vec3 on = chestPoint(p.x, p.z, &normal);
    squares += std::pow((p.y - on.y) * normal.y, 2);   // to first order
  }
  state.counters["rms_to_truth_mm"] = std::sqrt(squares / double(made.mesh.points.size()));
  state.counters["noise_mm"] = kNoise;
  state.counters["triangles"] = double(made.mesh.triangles.size());
}
BENCHMARK(rbfPectora)->Arg(200000)->Unit(benchmark::kSecond)->MeasureProcessCPUTime()->UseRealTime();
