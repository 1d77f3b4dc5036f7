#include "plugins/segmenter/thorax/sternum.h"

#include "kernel/physics/workers.h"
#include "plugins/segmenter/thorax/column_path.h"
#include "plugins/segmenter/thorax/sternum_outline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pectora::thorax {
namespace {

constexpr double kGridMm = 2.8;
constexpr double kManubriumHalfMm = 34, kBodyHalfMm = 24, kHalfDepthMm = 20;   // windows around the path
constexpr double kMarginMm = 5, kMostDepthMm = 26;  // around what was found there before
constexpr double kManubriumPart = 0.33;    // of the run's length
constexpr double kFarthestAsideMm = 12;    // of an end's centroid from the midline
constexpr double kLongestGapMm = 12, kLeastLengthMm = 25;
constexpr double kWidening = 0.25;       // of a side, upwards between the clavicles
constexpr double kTouchMm = 4;           // nearer to a wide window's border than this, clavicles and first ribs may touch the outline
constexpr double kCutMm = 1.4;           // nearer to a window's border than this, an outline is cut off by it
constexpr double kLeastScore = 0.1;
constexpr int kCentringRounds = 4;

double medianOf(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(v.size() / 2), v.end());
  return v[v.size() / 2];
}

/// Straight line x(z) that most of the sure slices lie on, within 6 mm, by trying all pairs of 48 of them (the sternum
/// is straight seen from the front; cartilages and clavicles that the path may have strayed to are not on it). Slices
/// near the spine's x count more.
struct Midline {
  double x = 0, z = 0, slope = 0;
  double at(double height) const { return x + slope * (height - z); }
};
Midline findMidline(const std::vector<Vec3>& path, const std::vector<float>& score, const Spine& spine, int firstSlice) {
  std::vector<std::size_t> sure;
  for (std::size_t s = 0; s < path.size(); ++s)
    if (score[s] > kLeastScore) sure.push_back(s);
  Midline best;
  double most = 0;
  const std::size_t stride = std::max<std::size_t>(1, sure.size() / 48);
  for (std::size_t a = 0; a < sure.size(); a += stride)
    for (std::size_t b = a + stride; b < sure.size(); b += stride) {
      const Vec3 p = path[sure[a]], q = path[sure[b]];
      const Midline line{p.x, p.z, (q.x - p.x) / (q.z - p.z)};
      if (std::abs(line.slope) > 0.2) continue;
      double support = 0;
      for (std::size_t s : sure) {
        const double off = (path[s].x - line.at(path[s].z)) / 6, aside = (path[s].x - spine.front[firstSlice + s].x) / 30;
        support += score[s] * std::max(0.0, 1 - off * off) / (1 + aside * aside);
      }
      if (support > most) most = support, best = line;
    }
  if (most == 0 && !sure.empty()) best = {path[sure[0]].x, path[sure[0]].z, 0};
  return best;
}

/// The straight line through the middles of the seen contours: median slope over pairs and median offset (Theil and Sen), so
/// that slices where cartilage or a clavicle was taken in do not draw it aside. The old line where fewer than five were seen.
Midline midlineOf(const std::vector<SternumSlice>& slices, double sliceSpacing, const Midline& old) {
  std::vector<Point2> middles;   // x = height, y = middle
  for (const SternumSlice& s : slices) {
    if (!s.isSeen) continue;
    const Sides sides = sidesOf(s.contour);
    middles.push_back({s.slice * sliceSpacing, 0.5 * (sides.right + sides.left)});
  }
  std::vector<double> slopes, offsets;
  for (std::size_t a = 0; a < middles.size(); ++a)
    for (std::size_t b = a + 1; b < middles.size(); ++b)
      if (middles[b].x - middles[a].x > kLeastLengthMm) slopes.push_back((middles[b].y - middles[a].y) / (middles[b].x - middles[a].x));
  if (middles.size() < 5 || slopes.empty()) return old;
  const double slope = medianOf(slopes);
  for (const Point2& m : middles) offsets.push_back(m.y - slope * m.x);
  return {medianOf(offsets), 0, slope};
}

/// Cuts off what goes on beyond the windows' borders (calcified cartilage, a clavicle's head): there the edge runs straight between the
/// nearest slices above and below that have an edge of their own on that side.
void cutOffSides(std::vector<SternumSlice>& run, std::vector<SternumWindow> windows, const Field& field, double boneHu) {
  std::vector<CutSides> cut;
  for (std::size_t n = 0; n < run.size(); ++n) cut.push_back(cutSides(run[n], windows[n], kCutMm));
  for (const bool isLeft : {false, true}) {
    const auto hasEdge = [&](std::size_t n) { return run[n].isSeen && !(isLeft ? cut[n].left : cut[n].right); };
    const auto edgeOf = [&](std::size_t n) { return isLeft ? sidesOf(run[n].contour).left : sidesOf(run[n].contour).right; };
    for (std::size_t n = 0; n < run.size(); ++n) {
      std::size_t below = n, above = n;
      while (below > 0 && !hasEdge(below)) --below;
      while (above + 1 < run.size() && !hasEdge(above)) ++above;
      if (hasEdge(n) || !run[n].isSeen || !hasEdge(below) || !hasEdge(above)) continue;
      (isLeft ? windows[n].left : windows[n].right) = std::lerp(edgeOf(below), edgeOf(above), double(n - below) / double(above - below));
    }
  }
  parallelFor(run.size(), [&](std::size_t n) {
    if (run[n].isSeen && (cut[n].right || cut[n].left)) run[n] = outlineIn(field, run[n].slice, windows[n], boneHu);
  });
}

}  // namespace

std::vector<SternumSlice> findSternum(const Body& body, const Field& field, const Spine& spine, double boneHu) {
  const int w = body.size[0], h = body.size[1], first = body.firstSlice, count = body.lastSlice - first + 1;
  const double sx = body.spacing.x, sy = body.spacing.y, sz = body.spacing.z;
  const int px = std::max(1, int(std::lround(kGridMm / sx))), py = std::max(1, int(std::lround(kGridMm / sy)));
  const int nx = w / px, ny = h / py, cells = nx * ny;

  // Score of every position of every slice.
  std::vector<float> score(std::size_t(cells) * count);
  parallelFor(count, [&](std::size_t s) {
    const int k = first + int(s);
    Plane bone(w, h);
    std::vector<int> skin(w, h);  // first row of the torso in every column
    for (int j = h - 1; j >= 0; --j)
      for (int i = 0; i < w; ++i)
        if (body.isTorso(i, j, k)) {
          skin[i] = j;
          bone.at(i, j) = boneness(body.hu[body.index(i, j, k)]);
        }
    const Sums sums(bone);
    const auto mean = [&](double x, double y, double x0, double x1, double y0, double y1) {
      return sums.mean(int(std::lround(x + x0 / sx)), int(std::lround(x + x1 / sx)), int(std::lround(y + y0 / sy)),
                       int(std::lround(y + y1 / sy)));
    };
    for (int c = 0; c < cells; ++c) {
      const double x = (c % nx + 0.5) * px, y = (c / nx + 0.5) * py;
      const Vec3 p = body.position(x - 0.5, y - 0.5, k);
      const double depth = (y - skin[std::min(w - 1, int(x))]) * sy;
      const bool isAllowed = std::abs(p.x - spine.front[k].x) < 40 && p.y < spine.front[k].y - 18 && depth > 2 && depth < 70;
      score[cells * s + c] = !isAllowed ? -1
          : float(mean(x, y, -12, 12, -5, 5) - 0.7 * mean(x, y, -12, 12, -17, -8) - 0.7 * mean(x, y, -12, 12, 9, 20));
    }
  });
  const ColumnPath path = bestColumn(score, nx, ny, count, int(3 / sz), std::max(1, int(std::ceil(sz / kGridMm))),
                                     float(0.06 * kGridMm / std::max(sz, 1.0)));

  // The midline, and the path's depth near it.
  std::vector<Vec3> at(count);
  for (int s = 0; s < count; ++s)
    at[s] = body.position((path.cell[s] % nx + 0.5) * px - 0.5, (path.cell[s] / nx + 0.5) * py - 0.5, first + s);
  Midline midline = findMidline(at, path.score, spine, first);
  const int near = std::max(1, int(std::lround(5 / sz)));
  std::vector<SternumSlice> slices(count);
  std::vector<SternumWindow> windows(count);
  // Where it was seen before, or just below, the window goes around it with a margin.
  const auto windowAround = [&](int s, const SternumSlice& seen, double halfWidth) {
    const auto [front, back] = std::minmax_element(seen.contour.begin(), seen.contour.end(), [](Point2 a, Point2 b) { return a.y < b.y; });
    return SternumWindow{{midline.at(at[s].z), 0.5 * (front->y + back->y), at[s].z}, halfWidth, std::min(0.5 * (back->y - front->y) + kMarginMm, kMostDepthMm),
                         halfWidth > kBodyHalfMm ? kTouchMm : 0};
  };
  const auto findContours = [&](int from, int to, double halfWidth) {
    parallelFor(to - from + 1, [&](std::size_t n) {
      const int s = from + int(n);
      const SternumSlice before = std::exchange(slices[s], {});
      slices[s].slice = first + s;
      if (before.isSeen) {
        windows[s] = windowAround(s, before, halfWidth);
      } else {
        // Else around the path's depth nearby.
        std::vector<double> y;
        for (int t = std::max(0, s - near); t <= std::min(count - 1, s + near); ++t)
          if (path.score[t] > kLeastScore && std::abs(at[t].x - midline.at(at[t].z)) < 14) y.push_back(at[t].y);
        if (y.empty()) return;
        windows[s] = {{midline.at(at[s].z), medianOf(y), at[s].z}, halfWidth, kHalfDepthMm};
      }
      slices[s] = outlineIn(field, first + s, windows[s], boneHu);
    });
  };
  // The longest run of slices with a contour.
  const int longestGap = int(kLongestGapMm / sz);
  int bestFrom = 0, bestTo = -1;
  findContours(0, count - 1, kBodyHalfMm);
  for (int s = 0, from = -1, to = -1; s <= count; ++s) {
    const bool isSeen = s < count && slices[s].isSeen;
    if (isSeen && (from < 0 || s - to - 1 > longestGap)) from = s;
    if (isSeen) to = s;
    if (from >= 0 && to - from > bestTo - bestFrom) bestFrom = from, bestTo = to;
  }
  if ((bestTo - bestFrom) * sz < kLeastLengthMm) return {};
  // A window beside the bone cuts its edge off, so the midline is brought to the middle of what was found, and the contours
  // are taken again. In the upper third, the manubrium, the window is wider.
  std::vector<SternumSlice> run;
  for (int round = 0; round < kCentringRounds; ++round) {
    const int wide = bestTo - int(kManubriumPart * (bestTo - bestFrom));
    findContours(bestFrom, wide - 1, kBodyHalfMm);
    findContours(wide, bestTo, kManubriumHalfMm);
    run.assign(slices.begin() + bestFrom, slices.begin() + bestTo + 1);
    midline = midlineOf(run, sz, midline);
  }
  // Between the clavicles' heads the path may have strayed to one of them; there the bone goes on from slice to slice, hardly wider.
  for (int s = bestTo + 1; s < count && slices[s - 1].isSeen; ++s) {
    windows[s] = windowAround(s, slices[s - 1], kManubriumHalfMm);
    const Sides below = sidesOf(slices[s - 1].contour);
    windows[s].right = below.right - kWidening * sz, windows[s].left = below.left + kWidening * sz;
    slices[s] = outlineIn(field, first + s, windows[s], boneHu);
    if (slices[s].isSeen) bestTo = s;
  }
  run.assign(slices.begin() + bestFrom, slices.begin() + bestTo + 1);
  cutOffSides(run, {windows.begin() + bestFrom, windows.begin() + bestTo + 1}, field, boneHu);
  // An end that lies aside (a calcified cartilage, a clavicle) is not sternum.
  const auto isEnd = [&](const SternumSlice& slice) {
    return slice.isSeen && std::abs(slice.shape.centroid.x - midline.at(slice.slice * sz)) < kFarthestAsideMm;
  };
  while (!run.empty() && !isEnd(run.back())) run.pop_back();
  while (!run.empty() && !isEnd(run.front())) run.erase(run.begin());
  if (run.size() * sz < kLeastLengthMm) return {};
  // Gaps are filled between their neighbours.
  for (std::size_t n = 1; n + 1 < run.size(); ++n) {
    if (run[n].isSeen) continue;
    // A gap takes the contour of the slice below it, moved to the line between both ends.
    std::size_t above = n;
    while (!run[above].isSeen) ++above;
    const SternumSlice &low = run[n - 1], &high = run[above];
    const double t = 1.0 / double(above - n + 1);
    const Point2 shift{t * (high.shape.centroid.x - low.shape.centroid.x), t * (high.shape.centroid.y - low.shape.centroid.y)};
    run[n].contour = low.contour;
    for (Point2& p : run[n].contour) p.x += shift.x, p.y += shift.y;
    run[n].shape = shapeOf(run[n].contour);
  }
  std::reverse(run.begin(), run.end());
  return run;
}

}  // namespace pectora::thorax
