#include "plugins/segmenter/thorax/rib_numbers.h"

#include "plugins/segmenter/thorax/assignment.h"

#include <algorithm>
#include <cmath>

namespace pectora::thorax {
namespace {

constexpr double kManubriumMm = 20, kBelowMm = 10, kNarrowing = 1.25;
constexpr double kSecondMm = 12, kOtherMm = 20;       // off the angle of Louis: the second rib at the most, any other at the least
constexpr double kEndMm = 24, kFlattening = 0.5;      // of a rib, whose direction its cartilage takes up; half as steeply

double medianOf(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(v.size() / 2), v.end());
  return v[v.size() / 2];
}

double widthOf(const SternumSlice& slice) {
  const Sides sides = sidesOf(slice.contour);
  return sides.left - sides.right;
}

/// Index of the one rib that runs to the notch; -1 if there is none, or more than one may.
int secondOf(const std::vector<FoundRib*>& ribs, Vec3 notch) {
  int second = -1, near = 0;
  for (std::size_t r = 0; r < ribs.size(); ++r) {
    const std::vector<Vec3>& line = ribs[r]->body.line;
    if (!ribs[r]->body.reachesJunction || line.size() < 2) continue;
    // The point where its last piece begins.
    std::size_t before = line.size() - 1;
    while (before > 0 && distance(line[before], line.back()) < kEndMm) --before;
    const Vec3 course = line.back() - line[before], way = notch - line.back();
    const double slope = course.z / std::max(1e-6, std::hypot(course.x, course.y));
    const double off = std::abs(line.back().z + kFlattening * slope * std::hypot(way.x, way.y) - notch.z);
    near += off < kOtherMm;
    if (off < kSecondMm) second = int(r);
  }
  return near == 1 ? second : -1;
}

}  // namespace

std::optional<SecondNotches> findSecondNotches(const std::vector<SternumSlice>& slices, double sliceSpacing) {
  const Sternum sternum = measureSternum(slices, sliceSpacing, 0);
  const auto at = [&](double z) {
    return std::find_if(slices.begin(), slices.end(), [&](const SternumSlice& s) { return std::abs(s.slice * sliceSpacing - z) <= 0.5 * sliceSpacing; });
  };
  const auto above = at(sternum.manubriosternalJoint.z + kManubriumMm), below = at(sternum.manubriosternalJoint.z - kBelowMm);
  if (above == slices.end() || below == slices.end() || widthOf(*above) < kNarrowing * widthOf(*below)) return {};
  SecondNotches notches{};
  for (const Notch& notch : sternum.notches)
    if (notch.rib == 2) notches[notch.side == Side::left] = notch.position;
  return notches;
}

Counting numberRibs(std::vector<FoundRib>& ribs, double bottom, double top, const std::optional<SecondNotches>& secondNotches) {
  std::array<std::vector<FoundRib*>, 2> sides;
  for (FoundRib& rib : ribs) {
    rib.number = 0;
    sides[rib.side == Side::left].push_back(&rib);
  }
  // Ribs whose backs lie above the CT come first, the one that was cut nearest to the front as the first of all.
  const auto frontY = [](const FoundRib* r) { return r->body.line.front().y; };
  for (auto& side : sides)
    std::stable_sort(side.begin(), side.end(), [&](const FoundRib* a, const FoundRib* b) {
      if (a->beginsAtTop != b->beginsAtTop) return a->beginsAtTop;
      return a->beginsAtTop ? frontY(a) < frontY(b) : a->backHeight > b->backHeight;
    });

  // The sides are paired by the heights of the ribs' backs; the first pass finds how much one side stands higher.
  const auto wholeOf = [](const std::vector<FoundRib*>& side) {
    std::vector<FoundRib*> whole;
    std::copy_if(side.begin(), side.end(), std::back_inserter(whole), [](const FoundRib* r) { return !r->beginsAtTop; });
    return whole;
  };
  const std::vector<FoundRib*> right = wholeOf(sides[0]), left = wholeOf(sides[1]);
  std::vector<int> match;
  double shift = 0;
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<std::vector<double>> cost(right.size(), std::vector<double>(left.size()));
    for (std::size_t r = 0; r < right.size(); ++r)
      for (std::size_t l = 0; l < left.size(); ++l) cost[r][l] = std::abs(right[r]->backHeight - left[l]->backHeight - shift);
    match = assign(cost, pass ? 10 : 14);
    std::vector<double> differences;
    for (std::size_t r = 0; r < right.size(); ++r)
      if (match[r] >= 0) differences.push_back(right[r]->backHeight - left[match[r]]->backHeight);
    if (!differences.empty()) shift = medianOf(differences);
  }
  // Levels: pairs and ribs without a partner, from the top.
  struct Level {
    double height;
    FoundRib *right, *left;
  };
  std::vector<Level> levels;
  std::vector<char> isPaired(left.size(), 0);
  for (std::size_t r = 0; r < right.size(); ++r) {
    FoundRib* partner = match[r] >= 0 ? left[match[r]] : nullptr;
    if (partner) isPaired[match[r]] = 1;
    levels.push_back({right[r]->backHeight, right[r], partner});
  }
  for (std::size_t l = 0; l < left.size(); ++l)
    if (!isPaired[l]) levels.push_back({left[l]->backHeight + shift, nullptr, left[l]});
  std::stable_sort(levels.begin(), levels.end(), [](const Level& a, const Level& b) { return a.height > b.height; });
  if (levels.size() < 2) return Counting::none;

  std::vector<double> gaps;
  for (std::size_t n = 1; n < levels.size(); ++n) gaps.push_back(levels[n - 1].height - levels[n].height);
  const double usual = medianOf(gaps);
  const bool isCutAbove = std::any_of(ribs.begin(), ribs.end(), [](const FoundRib& r) { return r.beginsAtTop; });
  Counting counting = Counting::none;
  int first = 0;
  if (!isCutAbove && top - levels.front().height >= std::max(12.0, std::min(gaps.front(), usual))) {
    counting = Counting::fromFirst;
    first = 1;
  } else if (levels.back().height - bottom >= 1.6 * std::max(usual, gaps.back())) {
    counting = Counting::fromLast;
    first = 13 - int(levels.size());
  } else {
    // A side's ribs are all there from its second on, so that the number of its first whole one, and of that one's level, follows.
    std::optional<int> counted;
    for (const Side side : {Side::right, Side::left}) {
      const std::vector<FoundRib*>& own = sides[side == Side::left];
      const int second = secondNotches ? secondOf(own, (*secondNotches)[side == Side::left]) : -1;
      const auto whole = std::find_if(own.begin(), own.end(), [](const FoundRib* r) { return !r->beginsAtTop; });
      if (second < 0 || whole == own.end()) continue;
      const auto level = std::find_if(levels.begin(), levels.end(), [&](const Level& l) { return l.right == *whole || l.left == *whole; });
      const int here = 2 + int(whole - own.begin()) - second - int(level - levels.begin());
      if (counted && *counted != here) return Counting::none;
      counted = here;
    }
    if (!counted) return Counting::none;
    counting = Counting::fromSternum;
    first = *counted;
  }
  const auto give = [](FoundRib* rib, int number) {
    if (rib && number >= 1 && number <= 12) rib->number = number;
  };
  for (std::size_t n = 0; n < levels.size(); ++n) {
    give(levels[n].right, first + int(n));
    give(levels[n].left, first + int(n));
  }
  // Ribs cut by the upper border go on upwards from the first whole one.
  for (auto& side : sides) {
    const auto whole = std::find_if(side.begin(), side.end(), [](const FoundRib* r) { return !r->beginsAtTop; });
    int number = first;
    for (auto rib = whole; rib != side.begin();) give(*--rib, --number);
  }
  return counting;
}

}  // namespace pectora::thorax
