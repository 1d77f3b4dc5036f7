#include "plugins/segmenter/thorax/rib_tracks.h"

#include "plugins/segmenter/thorax/assignment.h"

#include <algorithm>
#include <cmath>

namespace pectora::thorax {
namespace {

/// Straight line x(n) = x0 + slope (n - n0) through the last (or first) few centroids of a track.
struct Course {
  double plane = 0;
  Point2 at, slope;
  Point2 predict(double n) const { return {at.x + slope.x * (n - plane), at.y + slope.y * (n - plane)}; }
};

Course courseOf(const Track& track, bool atFront) {
  const int count = std::min<int>(8, int(track.items.size()));
  double n = 0, x = 0, y = 0, nn = 0, nx = 0, ny = 0;
  for (int t = 0; t < count; ++t) {
    const Track::Item& item = atFront ? track.items[track.items.size() - 1 - t] : track.items[t];
    n += item.plane, x += item.section.shape.centroid.x, y += item.section.shape.centroid.y;
  }
  n /= count, x /= count, y /= count;
  for (int t = 0; t < count; ++t) {
    const Track::Item& item = atFront ? track.items[track.items.size() - 1 - t] : track.items[t];
    const double d = item.plane - n;
    nn += d * d, nx += d * (item.section.shape.centroid.x - x), ny += d * (item.section.shape.centroid.y - y);
  }
  Course course{n, {x, y}, {0, 0}};
  if (count >= 3) {
    // A steep slope from few planes is not believed.
    const double most = count >= 6 ? 6 : 2.5;
    course.slope = {std::clamp(nx / nn, -most, most), std::clamp(ny / nn, -most, most)};
  }
  return course;
}

double length(Point2 a, Point2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

std::vector<Track> trackSections(const std::vector<std::vector<Section>>& sections, const TrackingLimits& limits) {
  std::vector<Track> done, live;
  for (int plane = Fan::kLast; plane >= Fan::kFirst; --plane) {
    const std::vector<Section>& here = sections[plane - Fan::kFirst];
    std::vector<std::vector<double>> cost(live.size(), std::vector<double>(here.size(), 1e9));
    for (std::size_t t = 0; t < live.size(); ++t) {
      const Section& last = live[t].items.back().section;
      const Point2 expected = courseOf(live[t], true).predict(plane);
      const Point2 shift{expected.x - last.shape.centroid.x, expected.y - last.shape.centroid.y};
      for (std::size_t s = 0; s < here.size(); ++s) {
        if (length(expected, here[s].shape.centroid) > 2 * limits.gateMm) continue;
        Loop moved = last.contour;
        for (Point2& p : moved) p.x += shift.x, p.y += shift.y;
        cost[t][s] = rmsDistance(moved, here[s].contour);
      }
    }
    const std::vector<int> match = assign(cost, limits.gateMm);
    std::vector<char> isTaken(here.size(), 0);
    for (std::size_t t = 0; t < live.size(); ++t)
      if (match[t] >= 0) live[t].items.push_back({plane, here[match[t]]}), isTaken[match[t]] = 1;
    for (std::size_t t = live.size(); t-- > 0;)
      if (live[t].frontPlane() - plane > limits.patiencePlanes) {
        done.push_back(std::move(live[t]));
        live.erase(live.begin() + std::ptrdiff_t(t));
      }
    for (std::size_t s = 0; s < here.size(); ++s)
      if (!isTaken[s]) live.push_back({{{plane, here[s]}}});
  }
  for (Track& track : live) done.push_back(std::move(track));
  std::erase_if(done, [](const Track& t) { return t.items.size() < 3; });

  // Merge: the pair whose lines meet best first, until none is left.
  while (true) {
    double best = 1;
    std::size_t bestBack = 0, bestFront = 0;
    for (std::size_t a = 0; a < done.size(); ++a)
      for (std::size_t b = 0; b < done.size(); ++b) {
        const int gap = done[a].frontPlane() - done[b].backPlane();
        if (a == b || gap < 1 || gap > limits.longestGapPlanes) continue;
        if (done[a].items.size() < 5 && done[b].items.size() < 5) continue;
        const double middle = 0.5 * (done[a].frontPlane() + done[b].backPlane());
        const Point2 ahead = courseOf(done[a], true).predict(middle), behind = courseOf(done[b], false).predict(middle);
        // Across the gap both lines must agree in their middle, and the ends must not lie too far apart.
        const double miss = length(ahead, behind) / limits.linkMm;
        const double jump = length(done[a].items.back().section.shape.centroid,
                                   done[b].items.front().section.shape.centroid) / (10 + 3.0 * gap);
        const double score = std::max(miss, jump) + 0.01 * gap;
        if (score < best) best = score, bestBack = a, bestFront = b;
      }
    if (best >= 1) break;
    Track& back = done[bestBack];
    back.items.insert(back.items.end(), done[bestFront].items.begin(), done[bestFront].items.end());
    done.erase(done.begin() + std::ptrdiff_t(bestFront));
  }
  std::erase_if(done, [&](const Track& t) { return int(t.items.size()) < limits.leastPlanes; });
  std::sort(done.begin(), done.end(), [](const Track& a, const Track& b) {
    return a.items.front().section.shape.centroid.y > b.items.front().section.shape.centroid.y;
  });
  return done;
}

}  // namespace pectora::thorax
