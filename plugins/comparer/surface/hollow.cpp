#include "plugins/comparer/surface/hollow.h"

#include "plugins/common/surface/point_normals.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace pectora {
namespace {

struct Flat {
  double x = 0, y = 0;
};

// Axial slices at equal distances.
struct Levels {
  double low = 0, step = 1;
  std::vector<std::vector<Flat>> slices;

  double z(std::size_t level) const { return low + step * double(level); }
};

// The lower border (least y) of the convex hull, from the least x to the greatest (Andrew's monotone chain).
std::vector<Flat> frontOf(std::vector<Flat> points) {
  std::sort(points.begin(), points.end(), [](Flat a, Flat b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Flat> hull;
  for (const Flat& p : points) {
    const auto turnsForward = [&] {
      const Flat a = hull[hull.size() - 2], b = hull.back();
      return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) <= 0;
    };
    while (hull.size() > 1 && turnsForward()) hull.pop_back();
    hull.push_back(p);
  }
  return hull;
}

// Where every slice is crossed by the surface's edges; then the strings over their fronts.
Levels stringsOver(const Mesh& skin) {
  constexpr double kStep = 2, kMost = 5000;
  Levels levels;
  double high = -INFINITY;
  levels.low = INFINITY;
  for (const Vec3& p : skin.points) levels.low = std::min(levels.low, p.z), high = std::max(high, p.z);
  levels.step = std::max(kStep, (high - levels.low) / kMost);
  levels.slices.resize(skin.points.empty() ? 0 : std::size_t((high - levels.low) / levels.step) + 1);
  for (const auto& t : skin.triangles)
    for (int k = 0; k < 3; ++k) {
      Vec3 a = skin.points[t[k]], b = skin.points[t[(k + 1) % 3]];
      if (a.z > b.z) std::swap(a, b);
      for (std::size_t l = std::size_t(std::ceil((a.z - levels.low) / levels.step)); l < levels.slices.size() && levels.z(l) <= b.z; ++l) {
        const double part = b.z > a.z ? std::clamp((levels.z(l) - a.z) / (b.z - a.z), 0.0, 1.0) : 0;
        const Vec3 p = lerp(a, b, part);
        levels.slices[l].push_back({p.x, p.y});
      }
    }
  for (auto& slice : levels.slices) slice = frontOf(std::move(slice));
  return levels;
}

// y of a string at x; nothing beside its ends.
std::optional<double> at(const std::vector<Flat>& string, double x) {
  const auto next = std::lower_bound(string.begin(), string.end(), x, [](Flat p, double value) { return p.x < value; });
  if (next == string.end() || (next == string.begin() && next->x > x)) return {};
  if (next == string.begin()) return next->y;
  const Flat a = *(next - 1), b = *next;
  return std::lerp(a.y, b.y, (x - a.x) / (b.x - a.x));
}

}  // namespace

std::vector<double> hollowDepths(const Mesh& skin) {
  const Levels levels = stringsOver(skin);
  const std::vector<Vec3> normals = pointNormals(skin);
  std::vector<double> depths(skin.points.size());
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (!(normals[i].y < 0)) continue;
    // Between the slices below and above; one of them alone at the surface's ends.
    const Vec3 p = skin.points[i];
    const double position = (p.z - levels.low) / levels.step;
    const std::size_t below = std::min(levels.slices.size() - 1, std::size_t(position)), above = std::min(levels.slices.size() - 1, below + 1);
    const auto first = at(levels.slices[below], p.x), second = at(levels.slices[above], p.x);
    if (!first && !second) continue;
    const double string = first && second ? std::lerp(*first, *second, std::clamp(position - double(below), 0.0, 1.0)) : first ? *first : *second;
    depths[i] = std::max(0.0, p.y - string);
  }
  return depths;
}

}  // namespace pectora
