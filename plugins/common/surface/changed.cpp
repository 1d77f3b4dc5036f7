#include "plugins/common/surface/changed.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pectora {

std::vector<bool> changedPoints(const std::vector<Vec3>& points, const std::vector<SurfaceHit>& found, double threshold, double margin) {
  std::vector<bool> moved(points.size());
  for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = !found[i].onBorder && std::abs(found[i].distance) > threshold;
  return withMargin(points, std::move(moved), margin);
}

std::vector<bool> withMargin(const std::vector<Vec3>& points, std::vector<bool> isMarked, double margin) {
  std::vector<Vec3> core;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (isMarked[i]) core.push_back(points[i]);
  if (core.empty() || margin <= 0) return isMarked;
  // A grid of cells as wide as the margin.
  using Key = std::array<std::int64_t, 3>;
  const auto key = [&](Vec3 p) { return Key{std::int64_t(std::floor(p.x / margin)), std::int64_t(std::floor(p.y / margin)), std::int64_t(std::floor(p.z / margin))}; };
  std::vector<std::pair<Key, Vec3>> cells;
  for (const Vec3& p : core) cells.emplace_back(key(p), p);
  const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::sort(cells.begin(), cells.end(), less);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = points[i];
    const Key home = key(p);
    for (int n = 0; n < 27 && !isMarked[i]; ++n) {
      const Key there{home[0] + n % 3 - 1, home[1] + n / 3 % 3 - 1, home[2] + n / 9 - 1};
      const auto [begin, end] = std::equal_range(cells.begin(), cells.end(), std::pair{there, Vec3{}}, less);
      for (auto c = begin; c != end && !isMarked[i]; ++c) isMarked[i] = distance(c->second, p) <= margin;
    }
  }
  return isMarked;
}

}  // namespace pectora
