#include "plugins/segmenter/thorax/ribs.h"

#include "kernel/physics/workers.h"
#include "kernel/value/curve.h"
#include "plugins/segmenter/thorax/assignment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pectora::thorax {
namespace {

constexpr double kBorderMm = 9;           // nearer to the CT's upper or lower border than this counts as cut by it
constexpr double kShoulderBladeMm = 14;  // farther out than the rib below: not a rib
constexpr double kInsideMm = 22;         // farther in than the rib above: not a rib

double medianOf(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(v.size() / 2), v.end());
  return v[v.size() / 2];
}

/// Share of a track's sections that have lung on their outer side.
double shareWithLungOutside(const Track& track, const Fan& fan, const Body& body) {
  int with = 0;
  for (const Track::Item& item : track.items) {
    const Point2 c = item.section.shape.centroid;
    int pixels = 0;
    for (double r = c.x + 6; r < c.x + 80; r += body.spacing.x) {
      const auto [i, j, k] = body.nearest(fan.position(item.plane, {r, c.y}));
      pixels += body.isLung(i, j, k);
    }
    with += pixels * body.spacing.x > 8;
  }
  return double(with) / double(track.items.size());
}

/// Cuts off the fragments of calcified cartilage that a track may have picked up beyond the end of the rib: from the
/// track's middle forwards, it ends before five sections in a row below half the usual area, and before a gap of more
/// than eight planes with less than 20 sections behind it.
void trimFront(Track& track) {
  std::vector<double> areas;
  for (const Track::Item& item : track.items) areas.push_back(item.section.shape.area);
  const double usual = medianOf(areas);
  std::size_t small = 0;
  for (std::size_t n = track.items.size() / 2; n < track.items.size(); ++n) {
    const bool isGap = n > 0 && track.items[n - 1].plane - track.items[n].plane > 8 && track.items.size() - n < 20;
    small = areas[n] < 0.5 * usual ? small + 1 : 0;
    if (isGap || small == 5) {
      track.items.resize(isGap ? n - small : n + 1 - small);
      return;
    }
  }
}

/// Whether more than a third of a line lies within 6 mm of another.
bool runsAlong(const std::vector<Vec3>& line, const std::vector<Vec3>& other) {
  const auto near = std::count_if(line.begin(), line.end(), [&](Vec3 p) {
    return std::any_of(other.begin(), other.end(), [&](Vec3 q) { return distance(p, q) < 6; });
  });
  return 3 * std::size_t(near) > line.size();
}

/// Median over common planes of how much farther out `a` lies than `b`; 0 if they share none.
double farther(const Track& a, const Track& b) {
  std::vector<double> differences;
  for (const Track::Item& p : a.items)
    for (const Track::Item& q : b.items)
      if (p.plane == q.plane) differences.push_back(p.section.shape.centroid.x - q.section.shape.centroid.x);
  return differences.empty() ? 0 : medianOf(differences);
}

}  // namespace

std::vector<Track> chooseRibs(std::vector<Track> tracks, const Fan& fan, const Body& body) {
  const double bottom = body.firstSlice * body.spacing.z, top = body.lastSlice * body.spacing.z;
  std::vector<Track> ribs, fromTop;
  for (Track& track : tracks) {
    trimFront(track);
    if (track.items.size() < 5 || shareWithLungOutside(track, fan, body) > 0.4) continue;
    const double first = track.items.front().section.shape.centroid.y, last = track.items.back().section.shape.centroid.y;
    const bool endsBelow = last < bottom + kBorderMm;
    if (track.backPlane() >= 140 && (track.frontPlane() <= 138 || (endsBelow && first > last))) ribs.push_back(std::move(track));
    else if (first > top - kBorderMm && track.items.size() >= 20 && first > last + 18) fromTop.push_back(std::move(track));
  }
  // From above downwards: nothing lies far inside the rib above it (kidneys, bowel with contrast agent).
  std::sort(ribs.begin(), ribs.end(), [](const Track& a, const Track& b) {
    return a.items.front().section.shape.centroid.y > b.items.front().section.shape.centroid.y;
  });
  for (std::size_t n = 1; n < ribs.size();)
    if (farther(ribs[n - 1], ribs[n]) > kInsideMm) ribs.erase(ribs.begin() + std::ptrdiff_t(n));
    else ++n;
  // From below upwards, each against the next rib below it.
  std::sort(fromTop.begin(), fromTop.end(), [](const Track& a, const Track& b) { return a.backPlane() > b.backPlane(); });
  for (Track& track : fromTop) {
    const bool isOutside = std::any_of(ribs.begin(), ribs.end(), [&](const Track& rib) {
      const double height = track.items.front().section.shape.centroid.y;
      return std::abs(rib.items.front().section.shape.centroid.y - height) < 60 && farther(track, rib) > kShoulderBladeMm;
    });
    if (!isOutside) ribs.push_back(std::move(track));
  }
  return ribs;
}

void partMergedFronts(std::vector<FoundRib>& ribs) {
  constexpr double kNearMm = 8, kApartMm = 11, kBeforeMm = 16, kBackMm = 60, kChordMm = 20;
  std::vector<std::vector<Vec3>> lines;
  for (const FoundRib& rib : ribs) lines.push_back(rib.body.line);
  for (std::size_t r = 0; r < ribs.size(); ++r) {
    const std::vector<Vec3>& line = lines[r];
    if (line.size() < 2 || polylineLength(line) < kBackMm + 2 * kChordMm) continue;
    const double step = polylineLength(line) / double(line.size() - 1);
    const auto back = std::size_t(kBackMm / step), chord = std::size_t(kChordMm / step);
    // How far a point is from the nearest other rib.
    const auto apart = [&](Vec3 p) {
      double nearest = 1e300;
      for (std::size_t o = 0; o < ribs.size(); ++o)
        for (std::size_t n = back; o != r && ribs[o].side == ribs[r].side && n < lines[o].size(); ++n) nearest = std::min(nearest, distance(lines[o][n], p));
      return nearest;
    };
    if (apart(line.back()) > kNearMm) continue;
    std::size_t last = line.size() - 1;
    while (last > back + 2 * chord && apart(line[last]) < kApartMm) --last;
    last = std::max(back + 2 * chord, last - std::size_t(kBeforeMm / step));
    const Vec3 before = normalized(line[last - chord] - line[last - 2 * chord]), now = normalized(line[last] - line[last - chord]);
    std::vector<Vec3>& mended = ribs[r].body.line;
    mended.resize(last + 1);
    for (std::size_t n = 1; mended.size() < line.size(); ++n)
      mended.push_back(mended.back() + normalized(now + (now - before) * (0.5 + double(n) / double(chord))) * step);
  }
}

std::vector<FoundRib> findRibs(const Body& body, const Field& field, const Spine& spine, const std::optional<SecondNotches>& secondNotches,
                               double boneHu, std::vector<std::string>& warnings, const std::function<void(double)>& step) {
  std::vector<FoundRib> ribs;
  const double bottom = body.firstSlice * body.spacing.z, top = body.lastSlice * body.spacing.z;
  SectionLimits limits;
  limits.boneHu = boneHu;
  for (Side side : {Side::right, Side::left}) {
    if (step) step(side == Side::right ? 0.0 : 0.5);
    const Fan fan = makeFan(side, spine, body.spacing);
    const std::vector<Track> tracks =
        chooseRibs(trackSections(findSections(fan, field, limits), TrackingLimits{}), fan, body);
    std::vector<FoundRib> found(tracks.size());
    parallelFor(tracks.size(), [&](std::size_t t) {
      std::vector<Vec3> rough;
      for (const Track::Item& item : tracks[t].items) rough.push_back(fan.position(item.plane, item.section.shape.centroid));
      found[t].side = side;
      found[t].body = marchRib(rough, field, spine, boneHu);
      found[t].backHeight = rough.front().z;
      found[t].beginsAtTop = tracks[t].backPlane() < 140;
    });
    // The longest first; what runs along a rib that is there already is its other cortex.
    std::stable_sort(found.begin(), found.end(), [](const FoundRib& a, const FoundRib& b) {
      return polylineLength(a.body.line) > polylineLength(b.body.line);
    });
    for (FoundRib& rib : found)
      if (polylineLength(rib.body.line) >= 20 &&
          std::none_of(ribs.begin(), ribs.end(), [&](const FoundRib& r) { return runsAlong(rib.body.line, r.body.line); }))
        ribs.push_back(std::move(rib));
  }
  partMergedFronts(ribs);
  switch (numberRibs(ribs, bottom, top, secondNotches)) {
    case Counting::fromFirst: break;
    case Counting::fromLast:
      warnings.push_back("the first rib is not in view: ribs are counted upwards from the lowest, taken as the 12th");
      break;
    case Counting::fromSternum:
      warnings.push_back("neither the first nor the last rib is in view: ribs are counted from the one whose cartilage runs to the angle of Louis, "
                         "taken as the second; look whether it is");
      break;
    case Counting::none:
      warnings.push_back("neither the first nor the last rib is in view: the ribs are not numbered");
      break;
  }
  for (Side side : {Side::right, Side::left}) {
    std::string missing;
    int least = 13, most = 0;
    for (const FoundRib& rib : ribs)
      if (rib.side == side && rib.number) least = std::min(least, rib.number), most = std::max(most, rib.number);
    for (int n = least; n <= most; ++n)
      if (std::none_of(ribs.begin(), ribs.end(), [&](const FoundRib& r) { return r.side == side && r.number == n; }))
        missing += (missing.empty() ? "" : ", ") + std::to_string(n);
    if (!missing.empty()) warnings.push_back(std::string("not found on the ") + sideName(side) + ": rib " + missing);
  }
  std::stable_sort(ribs.begin(), ribs.end(), [](const FoundRib& a, const FoundRib& b) {
    if (a.number != b.number) return (a.number ? a.number : 99) < (b.number ? b.number : 99);
    if (a.number) return a.side < b.side;
    return a.body.line.front().z > b.body.line.front().z;
  });
  return ribs;
}

double patientTurn(const std::vector<FoundRib>& ribs) {
  constexpr double kFirstMm = 60, kStepMm = 10;   // from the back on, beyond where the two sides lie close together
  std::vector<double> angles;
  int pairs = 0;
  for (const FoundRib& right : ribs)
    for (const FoundRib& left : ribs) {
      if (right.side != Side::right || left.side != Side::left || right.number == 0 || right.number != left.number) continue;
      if (!right.body.reachesVertebra || !left.body.reachesVertebra) continue;
      const double length = std::min(polylineLength(right.body.line), polylineLength(left.body.line));
      const std::vector<Vec3> r = resamplePolyline(right.body.line, int(polylineLength(right.body.line)) + 2);
      const std::vector<Vec3> l = resamplePolyline(left.body.line, int(polylineLength(left.body.line)) + 2);
      for (double at = kFirstMm; at < length - kStepMm; at += kStepMm) {
        const Vec3 across = l[std::size_t(at)] - r[std::size_t(at)];
        angles.push_back(std::atan2(across.y, across.x) * 180 / std::numbers::pi);
      }
      ++pairs;
    }
  return pairs >= 3 && !angles.empty() ? medianOf(angles) : 0;
}

}  // namespace pectora::thorax
