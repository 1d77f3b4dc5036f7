#include "plugins/segmenter/thorax/sternum_outline.h"

#include <algorithm>
#include <cmath>

namespace pectora::thorax {
namespace {

constexpr double kPixelMm = 0.7;
constexpr double kPieceAsideMm = 18, kPieceDeepMm = 12, kAcrossMm = 4;
constexpr double kLeastPieceMm2 = 12, kLeastMm2 = 25;
constexpr double kFilled = 0.92, kParted = 0.9, kLevelStep = 1.2;
constexpr int kLevels = 5;
// At a higher level: by how much front and back may move on the midline, which part of the hull must be left.
constexpr double kCortexMm = 2, kLeastKept = 0.4;

/// Convex hull (Andrew's monotone chain), positive area.
Loop convexHull(Loop points) {
  std::sort(points.begin(), points.end(), [](Point2 a, Point2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  const auto turn = [](Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); };
  Loop hull(2 * points.size());
  std::size_t n = 0;
  for (std::size_t i = 0; i < points.size(); hull[n++] = points[i++])
    while (n >= 2 && turn(hull[n - 2], hull[n - 1], points[i]) <= 0) --n;
  const std::size_t lower = n + 1;
  for (std::size_t i = points.size() - 1; i-- > 0; hull[n++] = points[i])
    while (n >= lower && turn(hull[n - 2], hull[n - 1], points[i]) <= 0) --n;
  hull.resize(n - 1);
  return hull;
}

/// What is brighter than a level in a window, mm from its centre.
struct Pieces {
  Loop points;
  double area = 0;
  bool crossesMiddle = false;
  Column middle;   // front and back on the midline
};
Pieces piecesIn(const Plane& plane, double level) {
  const int hx = plane.width / 2, hy = plane.height / 2;
  Pieces pieces;
  for (Loop& loop : isoContours(plane, float(level))) {
    for (Point2& p : loop) p = {(p.x - hx) * kPixelMm, (p.y - hy) * kPixelMm};
    const Shape shape = shapeOf(loop);
    if (shape.area < kLeastPieceMm2 || std::abs(shape.centroid.x) > kPieceAsideMm || std::abs(shape.centroid.y) > kPieceDeepMm) continue;
    const Sides sides = sidesOf(loop);
    pieces.crossesMiddle = pieces.crossesMiddle || (sides.right < kAcrossMm && sides.left > -kAcrossMm);
    const Column here = columnAt(loop, 0);
    pieces.middle = {std::min(pieces.middle.front, here.front), std::max(pieces.middle.back, here.back)};
    pieces.area += shape.area;
    pieces.points.insert(pieces.points.end(), loop.begin(), loop.end());
  }
  return pieces;
}

}  // namespace

CutSides cutSides(const SternumSlice& slice, const SternumWindow& window, double marginMm) {
  if (!slice.isSeen) return {};
  const Sides sides = sidesOf(slice.contour);
  return {sides.right < std::max(window.right, window.centre.x - window.halfWidth) + marginMm,
          sides.left > std::min(window.left, window.centre.x + window.halfWidth) - marginMm};
}

SternumSlice outlineIn(const Field& field, int slice, const SternumWindow& window, double boneHu) {
  const int hx = int(window.halfWidth / kPixelMm), hy = int(window.halfDepth / kPixelMm);
  const Vec3 centre = window.centre;
  Plane plane(2 * hx + 1, 2 * hy + 1, -1024);
  for (int j = -hy; j <= hy; ++j)
    for (int i = -hx; i <= hx; ++i) {
      const Vec3 p = centre + Vec3{i * kPixelMm, j * kPixelMm, 0};
      if (p.x >= window.right && p.x <= window.left) plane.at(i + hx, j + hy) = field.at(p);
    }
  // What touches comes off at a higher level, and the hull is smaller all at once.
  SternumSlice whole;
  whole.slice = slice;
  Column middle;   // of the whole
  CutSides cut;
  double filled = 0;
  for (int n = 0; n < kLevels; ++n) {
    const Pieces pieces = piecesIn(plane, boneHu * std::pow(kLevelStep, n));
    if (!pieces.crossesMiddle) break;
    SternumSlice found;
    found.slice = slice;
    for (Point2 p : pieces.points) found.contour.push_back({centre.x + p.x, centre.y + p.y});
    found.contour = convexHull(std::move(found.contour));
    found.shape = shapeOf(found.contour);
    found.isSeen = found.shape.area > kLeastMm2;
    if (n == 0) {
      whole = found, middle = pieces.middle, cut = cutSides(whole, window, window.touchMm), filled = pieces.area / whole.shape.area;
      if (filled > kFilled || (!cut.right && !cut.left)) break;
      continue;
    }
    // What is left must still be the whole of it, not one of its cortices, nor less on a side where nothing touches.
    const Sides had = sidesOf(whole.contour), has = sidesOf(found.contour);
    const bool isWhole = found.shape.area > kLeastKept * whole.shape.area && pieces.middle.front < middle.front + kCortexMm &&
                         pieces.middle.back > middle.back - kCortexMm && (cut.right || has.right < had.right + kCortexMm) &&
                         (cut.left || has.left > had.left - kCortexMm);
    if (!isWhole) break;
    // A cortex that breaks up fills less.
    if (found.shape.area < kParted * whole.shape.area && pieces.area / found.shape.area > filled) return found;
  }
  return whole;
}

}  // namespace pectora::thorax
