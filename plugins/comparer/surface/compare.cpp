#include "plugins/comparer/surface/compare.h"

#include "plugins/common/surface/changed.h"
#include "plugins/comparer/surface/hollow.h"

#include "kernel/stage/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

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

// What a point belongs to beside the overlap.
struct Membership {
  bool isPit = false, isHollow = false;
};

// The distances of the points that take part, by region of the reference that they face; the hollow is that of "unchanged".
struct Parts {
  std::vector<double> overlap, pit, hollow;
  std::vector<std::vector<double>> regions;

  explicit Parts(const CompareSettings& settings) : regions(settings.regions.size()) {}
  void add(double d, Membership in, Vec3 place, const CompareSettings& settings) {
    overlap.push_back(d);
    if (in.isPit) pit.push_back(d);
    if (in.isHollow) hollow.push_back(d);
    for (std::size_t r = 0; r < regions.size(); ++r)
      if (settings.regions[r].contains(place)) regions[r].push_back(d);
  }
};

// The surface before with what follows from it alone, and the pit of a reference against it.
struct Before {
  SurfaceTree tree;
  std::vector<bool> isHollow;                // of its own points
  std::vector<bool> isPit, facesHollow;      // of the reference's points

  Before(const Mesh& unchanged, const Mesh& reference, const CompareSettings& settings, const Poll& poll) : tree(unchanged) {
    const std::vector<double> depths = hollowDepths(unchanged);
    std::vector<bool> isDeep(depths.size());
    for (std::size_t i = 0; i < depths.size(); ++i) isDeep[i] = depths[i] > settings.pitThreshold;
    isHollow = withMargin(unchanged.points, std::move(isDeep), settings.pitMargin);
    const std::vector<SurfaceHit> found = tree.closest(reference.points, poll);
    isPit = changedPoints(reference.points, found, settings.pitThreshold, settings.pitMargin);
    for (const SurfaceHit& hit : found) facesHollow.push_back(isAt(isHollow, tree.corners(hit.triangle)));
  }
  static bool isAt(const std::vector<bool>& marks, const std::array<int, 3>& corners) { return marks[corners[0]] || marks[corners[1]] || marks[corners[2]]; }
};

// The way back: from the reference's points to the sample.
void measureBack(const Mesh& sample, const Mesh& reference, const Before* before, const CompareSettings& settings, const Poll& poll, Comparison& result) {
  const std::vector<SurfaceHit> found = SurfaceTree(sample).closest(reference.points, poll);
  std::vector<double> field(found.size(), kNoValue);
  Parts parts(settings);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (judge(found[i], settings) != kTakesPart) continue;
    field[i] = -found[i].distance;
    parts.add(field[i], before ? Membership{before->isPit[i], before->facesHollow[i]} : Membership{}, reference.points[i], settings);
  }
  result.reverseOverlap = statistics(std::move(parts.overlap));
  result.reversePit = statistics(std::move(parts.pit));
  if (before) result.regions.front().reverse = statistics(std::move(parts.hollow));
  for (std::size_t r = 0; r < parts.regions.size(); ++r) result.regions[r + (before != nullptr)].reverse = statistics(std::move(parts.regions[r]));
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
  std::vector<SurfaceHit> unchanged, copied;
  std::optional<Before> before;
  if (surfaces.unchanged) {
    before.emplace(*surfaces.unchanged, reference, settings, next());
    unchanged = before->tree.closest(points, next());
  }
  if (surfaces.copied) copied = SurfaceTree(*surfaces.copied).closest(points, next());

  // Sort the points by region.
  Comparison result;
  result.name = settings.name;
  PointField distances{"distance", "mm", std::vector<double>(points.size(), kNoValue)}, leftOut{"left_out", "", std::vector<double>(points.size())};
  PointField inPit{"pit", "", std::vector<double>(unchanged.size())}, inHollow{"hollow", "", std::vector<double>(unchanged.size())};
  PointField unchangedDistances{"unchanged_distance", "mm", std::vector<double>(unchanged.size(), kNoValue)};
  Parts here(settings), unchangedParts(settings), copiedParts(settings);
  std::vector<double> everywhere(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    everywhere[i] = found[i].distance;
    LeftOut why = judge(found[i], settings);
    if (why == kTakesPart && surfaces.unchanged) why = judge(unchanged[i], settings);
    if (why == kTakesPart && surfaces.copied) why = judge(copied[i], settings);
    leftOut.values[i] = why;
    if (why != kTakesPart) {
      ++result.excluded;
      continue;
    }
    Membership in;
    if (before) {
      in = {Before::isAt(before->isPit, reference.triangles[found[i].triangle]), Before::isAt(before->isHollow, before->tree.corners(unchanged[i].triangle))};
      inPit.values[i] = in.isPit;
      inHollow.values[i] = in.isHollow;
      unchangedDistances.values[i] = unchanged[i].distance;
      unchangedParts.add(unchanged[i].distance, in, found[i].point, settings);
    }
    distances.values[i] = found[i].distance;
    here.add(found[i].distance, in, found[i].point, settings);
    if (surfaces.copied) copiedParts.add(copied[i].distance, in, found[i].point, settings);
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
  const auto addRegion = [&](const std::string& name, std::vector<double>& own, std::vector<double>& beforehand, std::vector<double>& copy) {
    result.regions.push_back({name, statistics(std::move(own)), {}, statistics(std::move(beforehand)), statistics(std::move(copy))});
  };
  if (before) addRegion("hollow", here.hollow, unchangedParts.hollow, copiedParts.hollow);
  for (std::size_t r = 0; r < settings.regions.size(); ++r) addRegion(settings.regions[r].name, here.regions[r], unchangedParts.regions[r], copiedParts.regions[r]);
  if (measuresBack) measureBack(*mesh, reference, before ? &*before : nullptr, settings, next(), result);

  // The sample with its figures point by point, for pictures and files.
  std::vector<PointField> fields{std::move(distances), std::move(leftOut)};
  if (surfaces.unchanged) fields.insert(fields.end(), {std::move(inPit), std::move(inHollow), std::move(unchangedDistances)});
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
