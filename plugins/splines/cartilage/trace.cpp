#include "plugins/splines/cartilage/trace.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>

namespace pectora {
namespace {

// Mean HU in a small ball of voxels about a point, mm radius; air outside of the CT.
double meanHu(const Volume& ct, Vec3 p, double radius) {
  const Grid& g = ct.grid;
  const Vec3 v = g.toVoxel(p);
  const int reach[3] = {int(radius / g.spacing.x), int(radius / g.spacing.y), int(radius / g.spacing.z)};
  const int center[3] = {int(std::lround(v.x)), int(std::lround(v.y)), int(std::lround(v.z))};
  double sum = 0;
  int count = 0;
  for (int k = center[2] - reach[2]; k <= center[2] + reach[2]; ++k)
    for (int j = center[1] - reach[1]; j <= center[1] + reach[1]; ++j)
      for (int i = center[0] - reach[0]; i <= center[0] + reach[0]; ++i) {
        const double dx = (i - v.x) * g.spacing.x, dy = (j - v.y) * g.spacing.y, dz = (k - v.z) * g.spacing.z;
        if (dx * dx + dy * dy + dz * dz > radius * radius && count > 0) continue;
        const bool inside = i >= 0 && j >= 0 && k >= 0 && i < g.size[0] && j < g.size[1] && k < g.size[2];
        sum += inside ? ct.at(i, j, k) : -1000;
        ++count;
      }
  return sum / std::max(1, count);
}

// How unlike cartilage a mean HU is: 0 for cartilage, 1 for muscle, more for fat and air; calcification is forgiven.
double unlikeness(double hu, double cartilageHu) {
  const double below = (cartilageHu - hu) / 45, above = (hu - cartilageHu) / 200;
  return std::min(4.0, hu < cartilageHu ? below * below : above * above);
}

}  // namespace

std::optional<std::vector<Vec3>> traceCartilage(const Volume& ct, Vec3 start, std::span<const Vec3> guess,
                                                const std::function<bool(Vec3)>& isEnd, const TraceSettings& settings) {
  // The grid.
  Vec3 low = start, high = start;
  for (const Vec3& p : guess)
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  low -= {settings.margin, settings.margin, settings.margin};
  high += {settings.margin, settings.margin, settings.margin};
  const double h = settings.spacing;
  const int n[3] = {int((high.x - low.x) / h) + 1, int((high.y - low.y) / h) + 1, int((high.z - low.z) / h) + 1};
  const std::size_t nodes = std::size_t(n[0]) * n[1] * n[2];
  const auto position = [&](std::size_t node) {
    return low + Vec3{h * double(node % n[0]), h * double(node / n[0] % n[1]), h * double(node / n[0] / n[1])};
  };
  std::vector<float> unlike(nodes, -1);
  const auto unlikeAt = [&](std::size_t node) {
    if (unlike[node] < 0) unlike[node] = float(unlikeness(meanHu(ct, position(node), 4.5), settings.cartilageHu));
    return unlike[node];
  };

  // Dijkstra from the node nearest to the start.
  std::vector<float> cost(nodes, std::numeric_limits<float>::infinity());
  std::vector<std::int32_t> previous(nodes, -1);
  using Entry = std::pair<float, std::int32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const Vec3 s = (start - low) / h;
  const std::size_t first = (std::size_t(std::lround(s.z)) * n[1] + std::size_t(std::lround(s.y))) * n[0] + std::size_t(std::lround(s.x));
  cost[first] = 0;
  open.push({0.f, std::int32_t(first)});
  std::int32_t end = -1;
  while (!open.empty()) {
    const auto [here, node] = open.top();
    open.pop();
    if (here > cost[node]) continue;
    if (isEnd(position(node))) {
      end = node;
      break;
    }
    const int at[3] = {int(node % n[0]), int(node / n[0] % n[1]), int(node / n[0] / n[1])};
    for (int move = 0; move < 27; ++move) {
      const int d[3] = {move % 3 - 1, move / 3 % 3 - 1, move / 9 - 1};
      const int to[3] = {at[0] + d[0], at[1] + d[1], at[2] + d[2]};
      if (to[0] < 0 || to[1] < 0 || to[2] < 0 || to[0] >= n[0] || to[1] >= n[1] || to[2] >= n[2]) continue;
      const std::size_t next = (std::size_t(to[2]) * n[1] + to[1]) * n[0] + to[0];
      const double step = h * std::sqrt(double(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
      const float total = here + float(step * (0.15 + unlikeAt(next)));
      if (total >= cost[next]) continue;
      cost[next] = total;
      previous[next] = node;
      open.push({total, std::int32_t(next)});
    }
  }
  if (end < 0) return std::nullopt;

  // Back to the start; most of it must look like cartilage rather than muscle.
  std::vector<Vec3> path;
  std::size_t alike = 0;
  for (std::int32_t node = end; node >= 0; node = previous[node]) {
    path.push_back(position(node));
    alike += unlikeAt(node) < 0.5;
  }
  if (2 * alike < path.size()) return std::nullopt;
  path.back() = start;
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace pectora
