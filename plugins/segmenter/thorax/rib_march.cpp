#include "plugins/segmenter/thorax/rib_march.h"

#include "kernel/value/curve.h"
#include "plugins/segmenter/thorax/rib_fade.h"

#include <algorithm>
#include <cmath>

namespace pectora::thorax {
namespace {

constexpr double kStepMm = 2;
constexpr double kWindowMm = 12, kPixelMm = 0.6;
constexpr double kHeadMm = 20;             // from the vertebra's middle to where the centreline ends
constexpr double kDistrustedFrontMm = 16, kDistrustedBackMm = 4;   // of the rough line
constexpr double kFarthestOffMm = 2.5;     // of a cut's centre from the rough line
constexpr double kNeckMm = 24;
constexpr double kSharpTurn = 0.8;          // cosine of 37 degrees
constexpr double kLeastArea = 0.35;         // of a rib's usual one
constexpr double kReferenceFromMm = 15, kReferenceToMm = 75;   // behind the front of the inner part, where that is taken
constexpr double kSearchBackMm = 44;
constexpr int kLongestMergeMm = 30;
constexpr double kBorderMm = 5;            // an end nearer to the CT's border than this is cut by it
constexpr double kHighestSplit = 5;
constexpr double kLargestAreaMm2 = 300, kMergedArea = 1.3;
constexpr double kThickSliceMm = 3, kMergedAreaThick = 2.2;   // thick slices blur a section's size

Vec3 spineAt(const Spine& spine, double z, double sliceSpacing) {
  const double k = std::clamp(z / sliceSpacing, 0.0, double(spine.centre.size() - 1));
  const std::size_t low = std::size_t(k), high = std::min(low + 1, spine.centre.size() - 1);
  return lerp(spine.centre[low], spine.centre[high], k - double(low));
}

/// Distance to the nearest point of a line.
double distanceTo(const std::vector<Vec3>& line, Vec3 p) {
  double nearest = 1e300;
  for (const Vec3& q : line) nearest = std::min(nearest, distance(p, q));
  return nearest;
}

/// Direction of a line at one of its points, over a few neighbours.
Vec3 directionAt(const std::vector<Vec3>& line, std::size_t n) {
  const std::size_t a = n >= 4 ? n - 4 : 0, b = std::min(n + 4, line.size() - 1);
  return normalized(line[b] - line[a]);
}

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(v.size() / 2), v.end());
  return v[v.size() / 2];
}

/// Four rounds of the kernel (1, 2, 1) / 4; the ends stay.
void smoothLine(std::vector<Vec3>& line) {
  for (int round = 0; round < 4; ++round) {
    std::vector<Vec3> from = line;
    for (std::size_t n = 1; n + 1 < line.size(); ++n) line[n] = (from[n - 1] + from[n] * 2 + from[n + 1]) / 4;
  }
}

/// Direction in which a line's end goes on: that of its last 10 mm, with half of the turn since the 10 mm before.
Vec3 courseOf(const std::vector<Vec3>& line) {
  const std::size_t n = line.size();
  const Vec3 recent = normalized(line[n - 1] - line[n - std::min<std::size_t>(n, 6)]);
  const Vec3 before = n > 12 ? normalized(line[n - 6] - line[n - 12]) : recent;
  return normalized(recent + (recent - before) * 0.5);
}

/// Mean of the pixels within a contour.
double meanWithin(const Plane& plane, const Loop& loop) {
  double lowX = 1e9, lowY = 1e9, highX = -1e9, highY = -1e9, sum = 0;
  for (Point2 p : loop) lowX = std::min(lowX, p.x), highX = std::max(highX, p.x), lowY = std::min(lowY, p.y), highY = std::max(highY, p.y);
  int count = 0;
  for (int j = std::max(0, int(std::ceil(lowY))); j <= std::min<double>(plane.height - 1, highY); ++j)
    for (int i = std::max(0, int(std::ceil(lowX))); i <= std::min<double>(plane.width - 1, highX); ++i)
      if (isInside(loop, {double(i), double(j)})) sum += plane.at(i, j), ++count;
  return count > 0 ? sum / count : 0;
}

/// How much larger than usual a section must be to hold another bone.
double mergedArea(const Field& field) { return field.spacing().z > kThickSliceMm ? kMergedAreaThick : kMergedArea; }

}  // namespace

Cut cutAcross(const Field& field, Vec3 p, Vec3 direction, double boneHu, double usualAreaMm2) {
  // Two directions across the line, the first as level as possible.
  Vec3 e1 = cross(direction, {0, 0, 1});
  e1 = norm(e1) > 1e-3 ? normalized(e1) : Vec3{1, 0, 0};
  const Vec3 e2 = normalized(cross(direction, e1));
  const int half = int(kWindowMm / kPixelMm), size = 2 * half + 1;
  Plane plane(size, size);
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) {
      const Vec3 at = p + e1 * ((i - half) * kPixelMm) + e2 * ((j - half) * kPixelMm);
      plane.at(i, j) = field.contains(at) ? field.at(at) : -1024.0f;
    }
  // Where the contour around p is too large, a higher level may part what touches.
  const double largest = usualAreaMm2 > 0 ? std::min(kLargestAreaMm2, mergedArea(field) * usualAreaMm2) : kLargestAreaMm2;
  Cut cut;
  bool wasMerged = false;
  for (double level = boneHu; level <= kHighestSplit * boneHu; level *= 1.4) {
    cut = {};
    double nearest = 5;
    for (const Loop& loop : isoContours(plane, float(level))) {
      const Shape shape = shapeOf(loop);
      const double area = shape.area * kPixelMm * kPixelMm;
      const bool isAround = isInside(loop, {double(half), double(half)});
      if (area > largest || shape.spreadMajor * kPixelMm > 7.5) {
        cut.isMerged = cut.isMerged || isAround;
        continue;
      }
      if (area < (wasMerged ? 20 : 12)) continue;
      const double x = (shape.centroid.x - half) * kPixelMm, y = (shape.centroid.y - half) * kPixelMm;
      const double distance = isAround ? 0.01 * std::hypot(x, y) : std::hypot(x, y);
      if (distance >= nearest) continue;
      nearest = distance;
      cut.isFound = true;
      cut.centre = p + e1 * x + e2 * y;
      cut.areaMm2 = area;
      cut.meanHu = meanWithin(plane, loop);
    }
    if (cut.isFound || !cut.isMerged) break;
    wasMerged = true;
  }
  cut.isMerged = !cut.isFound && (cut.isMerged || wasMerged);
  return cut;
}

MarchedRib marchRib(const std::vector<Vec3>& rough, const Field& field, const Spine& spine, double boneHu) {
  MarchedRib rib;
  const double length = polylineLength(rough), sliceSpacing = field.spacing().z;
  if (length < 10) return rib;
  std::vector<Vec3> line = resamplePolyline(rough, std::max(5, int(length / kStepMm)));
  smoothLine(line);
  // The inner part of the rough line, twice centred on its cuts.
  const auto skipBack = std::ptrdiff_t(std::min(kDistrustedBackMm, 0.2 * length) / kStepMm);
  const auto skipFront = std::ptrdiff_t(std::min(kDistrustedFrontMm, 0.25 * length) / kStepMm);
  line = std::vector<Vec3>(line.begin() + skipBack, line.end() - skipFront);
  const std::vector<Vec3> original = line;
  double usual = 0, usualHu = 0;
  for (int round = 0; round < 2; ++round) {
    std::vector<Cut> cuts;
    std::vector<double> areas, means;
    for (std::size_t n = 0; n < line.size(); ++n) {
      cuts.push_back(cutAcross(field, line[n], directionAt(line, n), boneHu));
      if (cuts.back().isFound) areas.push_back(cuts.back().areaMm2), means.push_back(cuts.back().meanHu);
    }
    if (areas.size() < 5) return rib;
    usual = median(areas);
    // Brightness is compared with the rib's own, not far behind its end: it fades along the rib.
    const std::size_t end = means.size() - std::min(means.size() / 4, std::size_t(kReferenceFromMm / kStepMm));
    const std::size_t begin = means.size() - std::min(means.size(), std::size_t(kReferenceToMm / kStepMm));
    usualHu = median({means.begin() + std::ptrdiff_t(std::min(begin, end - 1)), means.begin() + std::ptrdiff_t(end)});
    // What is larger than the rib usually is holds another bone that touches it.
    for (std::size_t n = 0; n < line.size(); ++n)
      if (cuts[n].isFound && cuts[n].areaMm2 > mergedArea(field) * usual) cuts[n] = cutAcross(field, line[n], directionAt(line, n), boneHu, usual);
    // Where something else touches the rib, or only half of it was seen, the line goes straight on; beside the transverse
    // process the rough line is the better guess.
    std::vector<Vec3> centred;
    for (std::size_t n = 0; n < line.size(); ++n)
      if (cuts[n].isFound && cuts[n].areaMm2 < 1.7 * usual && cuts[n].areaMm2 > 0.4 * usual &&
          distanceTo(original, cuts[n].centre) < kFarthestOffMm)
        centred.push_back(cuts[n].centre);
      else if (n * kStepMm < kNeckMm)
        centred.push_back(line[n]);
    if (centred.size() < 5) return rib;
    line = resamplePolyline(centred, std::max(5, int(polylineLength(centred) / kStepMm)));
    smoothLine(line);
  }

  // Not into calcified cartilage: the line ends before three steps in its front part that are not the rib's.
  std::size_t others = 0;
  RibFade fade({}, usualHu);
  const auto isLikeRib = [&](const Cut& cut) { return cut.isFound && cut.areaMm2 > kLeastArea * usual && fade.goesOn(cut.meanHu); };
  for (std::size_t n = line.size() - std::min(line.size(), std::size_t(kSearchBackMm / kStepMm)); n < line.size(); ++n) {
    const Cut cut = cutAcross(field, line[n], directionAt(line, n), boneHu, usual);
    if (cut.isMerged) continue;
    const bool isRib = isLikeRib(cut);
    others = isRib ? 0 : others + 1;
    if (isRib) fade.add(cut.meanHu);
    if (others < 3 || n < 8) continue;
    line.resize(n - 2);
    break;
  }

  // Forwards to the end of the bone.
  std::vector<Vec3> front = line;
  int misses = 0, unsure = 0;   // steps without bone; steps since the last good one
  const Vec3 heading = courseOf(front);
  for (int step = 0; step < 60; ++step) {
    const Vec3 course = courseOf(front), expected = front.back() + course * kStepMm;
    if (!field.contains(expected, 2)) break;
    const Cut cut = cutAcross(field, expected, course, boneHu, usual);
    const bool isGood = isLikeRib(cut) && dot(course, heading) > kSharpTurn &&
                        distance(cut.centre, expected) < (unsure > 2 ? 1.5 : 2.5);
    if (!isGood && !cut.isMerged && ++misses == 3) break;
    if (!isGood && unsure >= kLongestMergeMm / kStepMm) break;
    unsure = isGood ? 0 : unsure + 1;
    if (isGood) misses = 0, fade.add(cut.meanHu);
    front.push_back(isGood ? lerp(expected, cut.centre, 0.7) : expected);
  }
  front.resize(front.size() - std::size_t(unsure));
  rib.reachesJunction = field.contains(front.back(), kBorderMm);

  // Backwards to the side of the vertebral body.
  std::vector<Vec3> back(front.rbegin(), front.rend());
  misses = 0;
  const auto fromBody = [&](Vec3 p) {
    const Vec3 c = spineAt(spine, p.z, sliceSpacing);
    return std::hypot(p.x - c.x, p.y - c.y);
  };
  double nearest = fromBody(back.back());
  for (int step = 0; step < 50 && nearest > kHeadMm; ++step) {
    Vec3 course = courseOf(back);
    const Vec3 tip = back.back(), body = spineAt(spine, tip.z, sliceSpacing);
    const double bend = misses > 0 ? 0.12 : 0.03;
    if (nearest < 60) course = normalized(course * (1 - bend) + normalized(body - tip) * bend);
    const Vec3 expected = tip + course * kStepMm;
    if (!field.contains(expected, 1)) break;
    const Cut cut = cutAcross(field, expected, course, boneHu);
    const bool isGood = cut.isFound && cut.areaMm2 < 2 * usual && cut.areaMm2 > 0.4 * usual &&
                        distance(cut.centre, expected) < 1.5;
    misses = isGood ? 0 : misses + 1;
    if (misses > 12) break;
    const Vec3 next = isGood ? lerp(expected, cut.centre, 0.5) : expected;
    const double now = fromBody(next);
    // Past the nearest point there is nothing more to find.
    if (now > nearest + 1.5) break;
    nearest = std::min(nearest, now);
    back.push_back(next);
  }
  rib.reachesVertebra = nearest < kHeadMm + 12;
  rib.line.assign(back.rbegin(), back.rend());
  smoothLine(rib.line);
  return rib;
}

}  // namespace pectora::thorax
