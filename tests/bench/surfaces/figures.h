// What every program is asked on these surfaces.
#pragma once

#include "tests/bench/surfaces/chest_fields.h"

#include "plugins/common/surface/surface_tree.h"

#include "kernel/value/comparison.h"

#include <benchmark/benchmark.h>

namespace pectora::bench {

/// True distances of compared(n)'s points.
inline std::vector<double> trueDistances(int n) {
  std::vector<double> distances;
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) distances.push_back(trueDistance(0.137 - 128 + 2.0 * 128 * c / (n - 1), 0.211 - 168 + 2.0 * 168 * r / (n - 1)));
  return distances;
}

/// Adds error against truth, wrong signs, and the paper's four figures to a benchmark's counters; `ours`, if it is another program's:
/// how far its distances and its figures lie from these.
inline void countDistances(benchmark::State& state, const std::vector<double>& distances, int n, const std::vector<double>* ours = nullptr) {
  const std::vector<double> truth = trueDistances(n);
  double largest = 0, wrong = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    largest = std::max(largest, std::abs(distances[i] - truth[i]));
    wrong += distances[i] * truth[i] < 0 && std::abs(truth[i]) > 0.01;
  }
  const DistanceStatistics s = statistics(distances);
  state.counters["error_max_mm"] = largest;
  state.counters["wrong_signs"] = wrong;
  state.counters["mean"] = s.mean;
  state.counters["sd"] = s.sd;
  state.counters["min"] = s.min;
  state.counters["max"] = s.max;
  if (!ours) return;
  double apart = 0;
  for (std::size_t i = 0; i < ours->size(); ++i) apart = std::max(apart, std::abs(distances[i] - (*ours)[i]));
  const DistanceStatistics o = statistics(*ours);
  state.counters["distances_apart_mm"] = apart;
  state.counters["figures_apart_mm"] = std::max({std::abs(s.mean - o.mean), std::abs(s.sd - o.sd), std::abs(s.min - o.min), std::abs(s.max - o.max)});
}

/// Pectora's distances on the same surfaces.
inline std::vector<double> ourDistances(const Mesh& fixed, const Mesh& sample) {
  std::vector<double> distances;
  for (const SurfaceHit& hit : SurfaceTree(fixed).closest(sample.points, [](double) {})) distances.push_back(hit.distance);
  return distances;
}

/// RMS distance of displaced targets from where a map brings them back to.
inline double targetError(const AffineMap& map) {
  double squares = 0;
  int count = 0;
  for (double x = -120; x <= 120; x += 20)
    for (double z = -160; z <= 160; z += 20, ++count) {
      const Vec3 p = chestPoint(x, z), d = map(displace(p)) - p;
      squares += dot(d, d);
    }
  return std::sqrt(squares / count);
}

/// Seeds whose target errors are averaged: one draw says little.
inline constexpr unsigned kSeeds = 4;

}  // namespace pectora::bench
