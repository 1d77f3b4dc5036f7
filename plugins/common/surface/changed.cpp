#include "plugins/common/surface/changed.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pectora {

std::vector<bool> changedPoints(const Mesh& mesh, const SurfaceTree& other, double threshold, double margin,
                                const std::function<void(double)>& poll) {
  const std::vector<SurfaceHit> change = other.closest(mesh.points, poll);
  std::vector<bool> moved(mesh.points.size());
  std::vector<Vec3> core;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    moved[i] = !change[i].onBorder && std::abs(change[i].distance) > threshold;
    if (moved[i]) core.push_back(mesh.points[i]);
  }
  if (core.empty() || margin <= 0) return moved;
  // The margin, by a grid of cells as wide as it.
  using Key = std::array<std::int64_t, 3>;
  const auto key = [&](Vec3 p) { return Key{std::int64_t(std::floor(p.x / margin)), std::int64_t(std::floor(p.y / margin)), std::int64_t(std::floor(p.z / margin))}; };
  std::vector<std::pair<Key, Vec3>> cells;
  for (const Vec3& p : core) cells.emplace_back(key(p), p);
  const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::sort(cells.begin(), cells.end(), less);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const Vec3 p = mesh.points[i];
    const Key home = key(p);
    for (int n = 0; n < 27 && !moved[i]; ++n) {
      const Key there{home[0] + n % 3 - 1, home[1] + n / 3 % 3 - 1, home[2] + n / 9 - 1};
      const auto [begin, end] = std::equal_range(cells.begin(), cells.end(), std::pair{there, Vec3{}}, less);
      for (auto c = begin; c != end && !moved[i]; ++c) moved[i] = distance(c->second, p) <= margin;
    }
  }
  return moved;
}

}  // namespace pectora
