#include "plugins/model/common/layers.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr int kFineColumns = 400;     // points of a pleura level that rays are cut with
constexpr double kFrontPart = 0.6;    // part of the chest's width over which rays run straight forwards

// Lowest and highest z of ribs and sternum, with a margin.
std::pair<double, double> cageExtent(const RibCage& cage, double margin) {
  double low = INFINITY, high = -INFINITY;
  for (const RibCurve& rib : cage.ribs)
    for (const Vec3& p : rib.curve.sample(20)) low = std::min(low, p.z), high = std::max(high, p.z);
  for (const Cartilage& c : cage.cartilages)
    for (const Vec3& p : c.curve.sample(20)) low = std::min(low, p.z);
  // Above the sternum there are shoulders and neck, which the operation does not move.
  if (!cage.anatomy->sternum.contours.empty()) high = std::min(high, cage.anatomy->sternum.jugularNotch.z);
  return {low - margin, high + margin};
}

// Where the ray in the axial plane from `center` through `skin` leaves the pleura: the furthest crossing that is not beyond the
// skin; the nearer end of the line where there is none. So skin and pleura face each other, also in a pit.
Vec3 facingPoint(const std::vector<Vec3>& pleura, Vec3 skin, Vec3 center) {
  const double dx = skin.x - center.x, dy = skin.y - center.y;
  double best = -1;
  for (std::size_t i = 1; i < pleura.size(); ++i) {
    // center + t d = a + s (b - a), in x and y.
    const Vec3 a = pleura[i - 1], e = pleura[i] - a;
    const double cross = dx * e.y - dy * e.x;
    if (cross == 0) continue;
    const double ax = a.x - center.x, ay = a.y - center.y;
    const double t = (ax * e.y - ay * e.x) / cross, s = (ax * dy - ay * dx) / cross;
    if (s >= 0 && s <= 1 && t > best && t <= 1) best = t;
  }
  if (best > 0) return {center.x + best * dx, center.y + best * dy, skin.z};
  return distance(skin, pleura.front()) < distance(skin, pleura.back()) ? pleura.front() : pleura.back();
}

// A level between two slices of a layer, point by point at equal arc length.
std::vector<Vec3> levelAt(const std::vector<LayerSlice>& layer, double z, int columns) {
  std::size_t above = 1;
  while (above + 1 < layer.size() && layer[above].z < z) ++above;
  const LayerSlice &a = layer[above - 1], &b = layer[above];
  const double t = std::clamp((z - a.z) / (b.z - a.z), 0.0, 1.0);
  const std::vector<Vec3> low = resamplePolyline(a.points, columns), high = resamplePolyline(b.points, columns);
  std::vector<Vec3> level(columns);
  for (int c = 0; c < columns; ++c) level[c] = lerp(low[c], high[c], t);
  return level;
}

}  // namespace

void LayerSettings::describe(Visitor& v) {
  v.real("spacing", spacing, "mm", {1, 50}, {4, 12}, "Distance between neighbouring skin points");
  v.real("margin", margin, "mm", {0, 200}, {0, 60}, "How far the model reaches above the sternum and below the ribs");
  v.real("still", still, "mm", {0, 10}, {0, 1}, "Leave out of the computation what the operation moves by less than this; 0: compute all");
  v.real("accuracy", accuracy, "mm", {0, 100}, {0, 2}, "Run only those of the effects that change the skin by about as much, which rough solves tell before the solver's own; 0: all of them");
}

void buildLayers(const LayerSettings& settings, Scene& scene) {
  const Anatomy& anatomy = *scene.cage->anatomy;
  scene.still = settings.still;
  scene.effectAccuracy = settings.accuracy;
  const auto [low, high] = cageExtent(*scene.cage, settings.margin);

  // The longest run of levels with both layers whole.
  std::size_t bestBegin = 0, bestEnd = 0;
  for (std::size_t begin = 0; begin < anatomy.skin.size();) {
    std::size_t end = begin;
    while (end < anatomy.skin.size() && !anatomy.skin[end].clipped && anatomy.skin[end].points.size() >= 2 &&
           end < anatomy.pleura.size() && anatomy.pleura[end].points.size() >= 2 && anatomy.skin[end].z >= low &&
           anatomy.skin[end].z <= high)
      ++end;
    if (end - begin > bestEnd - bestBegin) bestBegin = begin, bestEnd = end;
    begin = std::max(end, begin + 1);
  }
  const double extent = bestEnd > bestBegin ? anatomy.skin[bestEnd - 1].z - anatomy.skin[bestBegin].z : 0;
  if (extent < 4 * settings.spacing)
    throw Error("too little of the chest wall has both skin and pleura in view to build a model")
        .given(fmt::format("{:.0f} mm", extent)).allowed(fmt::format("{:.0f} mm or more", 4 * settings.spacing))
        .advise("Use a CT whose field of view holds the whole skin");
  const std::vector<LayerSlice> skin(anatomy.skin.begin() + bestBegin, anatomy.skin.begin() + bestEnd);
  const std::vector<LayerSlice> pleura(anatomy.pleura.begin() + bestBegin, anatomy.pleura.begin() + bestEnd);

  // Rows and columns at about the wanted spacing.
  double longest = 0;
  for (const LayerSlice& slice : skin) longest = std::max(longest, polylineLength(slice.points));
  scene.rows = std::max(5, int(std::lround(extent / settings.spacing)) + 1);
  scene.columns = std::max(5, int(std::lround(longest / settings.spacing)) + 1);
  for (int r = 0; r < scene.rows; ++r) {
    const double z = skin.front().z + extent * r / (scene.rows - 1);
    const std::vector<Vec3> outer = levelAt(skin, z, scene.columns), inner = levelAt(pleura, z, kFineColumns);
    // Rays start on the middle part of the coronal line: straight forwards over the front, fanning out at the sides.
    const Vec3 center = (outer.front() + outer.back()) / 2;
    const double reach = kFrontPart * std::abs(inner.back().x - inner.front().x) / 2;
    for (const Vec3& p : outer) {
      scene.outer.push_back(p);
      scene.inner.push_back(facingPoint(inner, p, center + Vec3{std::clamp(p.x - center.x, -reach, reach), 0, 0}));
    }
  }

  // Means over the grid, which the spring constants follow from.
  double rowSum = 0, columnSum = 0, thicknessSum = 0;
  int frontPoints = 0;
  for (int r = 0; r < scene.rows; ++r) {
    for (int c = 0; c < scene.columns; ++c) {
      const int i = scene.index(r, c);
      // The operation acts on the middle third; the thick flanks would make the wall look softer than it is there.
      if (3 * c >= scene.columns && 3 * c < 2 * scene.columns) thicknessSum += distance(scene.outer[i], scene.inner[i]), ++frontPoints;
      if (r > 0) rowSum += distance(scene.outer[i], scene.outer[i - scene.columns]);
      if (c > 0) columnSum += distance(scene.outer[i], scene.outer[i - 1]);
    }
  }
  scene.rowSpacing = rowSum / ((scene.rows - 1) * scene.columns);
  scene.columnSpacing = columnSum / (scene.rows * (scene.columns - 1));
  scene.thickness = thicknessSum / frontPoints;
}

}  // namespace pectora
