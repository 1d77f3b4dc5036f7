#include "plugins/comparer/surface/compare.h"

#include "plugins/comparer/surface/surface_tree.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pectora {
namespace {

constexpr std::size_t kBlock = 4096;
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

std::vector<SurfaceHit> hits(const SurfaceTree& tree, const std::vector<Vec3>& points, const std::function<void(double)>& poll) {
  std::vector<SurfaceHit> found(points.size());
  const std::size_t blocks = (points.size() + kBlock - 1) / kBlock;
  // In rounds, so that progress and cancel are seen between them.
  constexpr std::size_t kRound = 32;
  for (std::size_t first = 0; first < blocks; first += kRound) {
    poll(double(first) / double(blocks));
    parallelFor(std::min(kRound, blocks - first), [&](std::size_t b) {
      const std::size_t begin = (first + b) * kBlock, end = std::min(points.size(), begin + kBlock);
      for (std::size_t i = begin; i < end; ++i) found[i] = tree.closest(points[i]);
    });
  }
  return found;
}

// Which points of the reference belong to the pit: those that moved, and their neighbours within the margin.
std::vector<bool> pitPoints(const Mesh& reference, const SurfaceTree& unchanged, const CompareSettings& settings,
                            const std::function<void(double)>& poll) {
  const std::vector<SurfaceHit> change = hits(unchanged, reference.points, poll);
  std::vector<bool> moved(reference.points.size());
  std::vector<Vec3> core;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    moved[i] = !change[i].onBorder && std::abs(change[i].distance) > settings.pitThreshold;
    if (moved[i]) core.push_back(reference.points[i]);
  }
  // The margin, by a grid of cells as wide as the margin.
  if (core.empty() || settings.pitMargin <= 0) return moved;
  const double cell = settings.pitMargin;
  const auto key = [&](Vec3 p) {
    return std::array<std::int64_t, 3>{std::int64_t(std::floor(p.x / cell)), std::int64_t(std::floor(p.y / cell)), std::int64_t(std::floor(p.z / cell))};
  };
  std::vector<std::pair<std::array<std::int64_t, 3>, Vec3>> cells;
  for (const Vec3& p : core) cells.emplace_back(key(p), p);
  const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::sort(cells.begin(), cells.end(), less);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const Vec3 p = reference.points[i];
    const auto home = key(p);
    for (int n = 0; n < 27 && !moved[i]; ++n) {
      const std::array<std::int64_t, 3> there{home[0] + n % 3 - 1, home[1] + n / 3 % 3 - 1, home[2] + n / 9 - 1};
      const auto [begin, end] = std::equal_range(cells.begin(), cells.end(), std::pair{there, Vec3{}}, less);
      for (auto c = begin; c != end && !moved[i]; ++c) moved[i] = distance(c->second, p) <= settings.pitMargin;
    }
  }
  return moved;
}

Histogram makeHistogram(const std::vector<double>& distances, double width) {
  Histogram h;
  h.binWidth = width;
  if (distances.empty()) return h;
  const auto [low, high] = std::minmax_element(distances.begin(), distances.end());
  h.low = std::floor(*low / width) * width;
  h.counts.assign(std::size_t((*high - h.low) / width) + 1, 0);
  for (double d : distances) ++h.counts[std::min(h.counts.size() - 1, std::size_t((d - h.low) / width))];
  return h;
}

}  // namespace

Comparison compareSurfaces(std::shared_ptr<const Value> sample, const Mesh& reference, const Mesh* unchanged,
                           const CompareSettings& settings, const std::function<void(double)>& poll) {
  const auto* mesh = dynamic_cast<const Mesh*>(sample.get());
  const auto* cloud = dynamic_cast<const Points*>(sample.get());
  const std::vector<Vec3>& points = mesh ? mesh->points : cloud->points;
  if (points.empty()) throw Error("the surface to be measured has no points").of("sample");
  for (const Vec3& p : points)
    if (!isFinite(p)) throw Error("the surface to be measured has a coordinate that is not a finite number").of("sample").advise("Clean the scan first");

  const SurfaceTree tree(reference);
  const std::vector<SurfaceHit> found = hits(tree, points, [&](double f) { poll(0.5 * f); });
  std::vector<bool> pit;
  std::vector<SurfaceHit> before;
  if (unchanged) {
    const SurfaceTree unchangedTree(*unchanged);
    pit = pitPoints(reference, unchangedTree, settings, poll);
    before = hits(unchangedTree, points, [&](double f) { poll(0.5 + 0.5 * f); });
  }

  // A point takes part if both surfaces have a counterpart of it, so that baseline and comparison see the same points.
  Comparison result;
  result.name = settings.name;
  std::vector<double> field(points.size(), kNoValue), overlap, inPit, baseOverlap, basePit;
  const auto counts = [&](const SurfaceHit& hit) { return !hit.onBorder && std::abs(hit.distance) <= settings.maxDistance; };
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!counts(found[i]) || (unchanged && !counts(before[i]))) {
      ++result.excluded;
      continue;
    }
    field[i] = found[i].distance;
    overlap.push_back(found[i].distance);
    if (!unchanged) continue;
    baseOverlap.push_back(before[i].distance);
    const auto& corners = reference.triangles[found[i].triangle];
    if (pit[corners[0]] || pit[corners[1]] || pit[corners[2]]) {
      inPit.push_back(found[i].distance);
      basePit.push_back(before[i].distance);
    }
  }
  if (overlap.empty())
    throw Error("the two surfaces do not overlap: no point has a counterpart").advise("Register them first, and check the units");
  result.histogram = makeHistogram(overlap, settings.binWidth);
  result.overlap = statistics(std::move(overlap));
  result.pit = statistics(std::move(inPit));
  result.baselineOverlap = statistics(std::move(baseOverlap));
  result.baselinePit = statistics(std::move(basePit));

  // The sample with its distances, for pictures and files.
  PointField distances{"distance", "mm", std::move(field)};
  if (mesh) {
    auto colored = std::make_shared<Mesh>(*mesh);
    colored->fields = {std::move(distances)};
    result.sample = std::move(colored);
  } else {
    auto colored = std::make_shared<Points>(*cloud);
    colored->fields = {std::move(distances)};
    result.sample = std::move(colored);
  }
  return result;
}

}  // namespace pectora
