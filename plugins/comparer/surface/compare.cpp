#include "plugins/comparer/surface/compare.h"

#include "plugins/common/surface/changed.h"

#include "kernel/stage/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pectora {
namespace {

using Poll = std::function<void(double)>;
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

// Why a point takes no part in the statistics.
enum LeftOut { kTakesPart = 0, kBeyondBorder = 1, kTooFar = 2 };

LeftOut judge(const SurfaceHit& hit, const CompareSettings& settings) {
  if (settings.isPaper) return kTakesPart;
  if (std::abs(hit.distance) > settings.maxDistance) return kTooFar;
  return hit.onBorder ? kBeyondBorder : kTakesPart;
}

Histogram makeHistogram(const std::vector<double>& distances, double width) {
  Histogram h;
  h.binWidth = width;
  const auto [low, high] = std::minmax_element(distances.begin(), distances.end());
  // A bin so narrow that there would be millions of them is widened.
  constexpr double kMostBins = 1e5;
  h.binWidth = std::max(width, (*high - *low) / kMostBins);
  h.low = std::floor(*low / h.binWidth) * h.binWidth;
  h.counts.assign(std::size_t((*high - h.low) / h.binWidth) + 1, 0);
  for (double d : distances) ++h.counts[std::min(h.counts.size() - 1, std::size_t((d - h.low) / h.binWidth))];
  return h;
}

// The distances of the points that take part, by the region of the reference that they face.
struct Parts {
  std::vector<double> overlap, pit;
  std::vector<std::vector<double>> regions;

  explicit Parts(const CompareSettings& settings) : regions(settings.regions.size()) {}
  void add(double d, bool isPit, Vec3 place, const CompareSettings& settings) {
    overlap.push_back(d);
    if (isPit) pit.push_back(d);
    for (std::size_t r = 0; r < regions.size(); ++r)
      if (settings.regions[r].contains(place)) regions[r].push_back(d);
  }
};

// The way back: from the reference's points to the sample.
void measureBack(const Mesh& sample, const Mesh& reference, const std::vector<bool>& pit, const CompareSettings& settings, const Poll& poll, Comparison& result) {
  const std::vector<SurfaceHit> found = SurfaceTree(sample).closest(reference.points, poll);
  std::vector<double> field(found.size(), kNoValue);
  Parts parts(settings);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (judge(found[i], settings) != kTakesPart) continue;
    field[i] = -found[i].distance;
    parts.add(field[i], !pit.empty() && pit[i], reference.points[i], settings);
  }
  result.reverseOverlap = statistics(std::move(parts.overlap));
  result.reversePit = statistics(std::move(parts.pit));
  for (std::size_t r = 0; r < parts.regions.size(); ++r) result.regions[r].reverse = statistics(std::move(parts.regions[r]));
  auto colored = std::make_shared<Mesh>(reference);
  colored->fields = {{"distance", "mm", std::move(field)}};
  result.reference = std::move(colored);
}

}  // namespace

Comparison compareSurfaces(std::shared_ptr<const Value> sample, const Surfaces& surfaces, const CompareSettings& settings, const Poll& poll) {
  const auto* mesh = dynamic_cast<const Mesh*>(sample.get());
  const auto* cloud = dynamic_cast<const Points*>(sample.get());
  const std::vector<Vec3>& points = mesh ? mesh->points : cloud->points;
  const Mesh& reference = surfaces.reference;
  if (points.empty()) throw Error("the surface to be measured has no points").of("sample");
  for (const std::vector<Vec3>* all : {&points, &reference.points})
    for (const Vec3& p : *all)
      if (!isFinite(p) || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > TriangleBvh::kHuge)
        throw Error("a surface has a coordinate that is not a finite number, or beyond any body").of(all == &points ? "sample" : "reference").advise("Clean the scan first");

  // Distances to all surfaces.
  const bool measuresBack = mesh && settings.bothWays && !mesh->triangles.empty();
  const int steps = 1 + 2 * (surfaces.unchanged != nullptr) + (surfaces.copied != nullptr) + measuresBack;
  int step = 0;
  const auto next = [&] { return [&poll, steps, now = step++](double f) { poll((now + f) / steps); }; };
  const std::vector<SurfaceHit> found = SurfaceTree(reference).closest(points, next());
  std::vector<SurfaceHit> before, copied;
  std::vector<bool> pit;
  if (surfaces.unchanged) {
    const SurfaceTree unchanged(*surfaces.unchanged);
    pit = changedPoints(reference, unchanged, settings.pitThreshold, settings.pitMargin, next());
    before = unchanged.closest(points, next());
  }
  if (surfaces.copied) copied = SurfaceTree(*surfaces.copied).closest(points, next());

  // Sort the points by region.
  Comparison result;
  result.name = settings.name;
  PointField distances{"distance", "mm", std::vector<double>(points.size(), kNoValue)}, leftOut{"left_out", "", std::vector<double>(points.size())};
  PointField inPit{"pit", "", std::vector<double>(before.size())}, unchangedDistances{"unchanged_distance", "mm", std::vector<double>(before.size(), kNoValue)};
  Parts here(settings), unchangedParts(settings), copiedParts(settings);
  std::vector<double> everywhere(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    everywhere[i] = found[i].distance;
    LeftOut why = judge(found[i], settings);
    if (why == kTakesPart && surfaces.unchanged) why = judge(before[i], settings);
    if (why == kTakesPart && surfaces.copied) why = judge(copied[i], settings);
    leftOut.values[i] = why;
    if (why != kTakesPart) {
      ++result.excluded;
      continue;
    }
    const auto& corners = reference.triangles[found[i].triangle];
    const bool isPit = !pit.empty() && (pit[corners[0]] || pit[corners[1]] || pit[corners[2]]);
    distances.values[i] = found[i].distance;
    here.add(found[i].distance, isPit, found[i].point, settings);
    if (surfaces.unchanged) {
      inPit.values[i] = isPit;
      unchangedDistances.values[i] = before[i].distance;
      unchangedParts.add(before[i].distance, isPit, found[i].point, settings);
    }
    if (surfaces.copied) copiedParts.add(copied[i].distance, isPit, found[i].point, settings);
  }
  if (here.overlap.empty())
    throw Error("the two surfaces do not overlap: no point has a counterpart").advise("Register them first, and check the units");

  result.everywhere = statistics(std::move(everywhere));
  result.histogram = makeHistogram(here.overlap, settings.binWidth);
  result.overlap = statistics(std::move(here.overlap));
  result.pit = statistics(std::move(here.pit));
  result.baselineOverlap = statistics(std::move(unchangedParts.overlap));
  result.baselinePit = statistics(std::move(unchangedParts.pit));
  result.copiedOverlap = statistics(std::move(copiedParts.overlap));
  result.copiedPit = statistics(std::move(copiedParts.pit));
  for (std::size_t r = 0; r < settings.regions.size(); ++r)
    result.regions.push_back({settings.regions[r].name, statistics(std::move(here.regions[r])), {}, statistics(std::move(unchangedParts.regions[r]))});
  if (measuresBack) measureBack(*mesh, reference, pit, settings, next(), result);

  // The sample with its figures point by point, for pictures and files.
  std::vector<PointField> fields{std::move(distances), std::move(leftOut)};
  if (surfaces.unchanged) fields.insert(fields.end(), {std::move(inPit), std::move(unchangedDistances)});
  if (mesh) {
    auto colored = std::make_shared<Mesh>(*mesh);
    colored->fields = std::move(fields);
    result.sample = std::move(colored);
  } else {
    auto colored = std::make_shared<Points>(*cloud);
    colored->fields = std::move(fields);
    result.sample = std::move(colored);
  }
  return result;
}

}  // namespace pectora
