#include "plugins/common/surface/surface_tree.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pectora {
namespace {

// Spreads 20 bits so that two free bits follow each.
std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffull;
  v = (v | v << 16) & 0x1f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  return (v | v << 2) & 0x1249249249249249ull;
}

}  // namespace

std::vector<std::int32_t> spatialOrder(const std::vector<Vec3>& points) {
  Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  for (const Vec3& p : points)
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  const Vec3 side = high - low;
  const double longest = std::max({side.x, side.y, side.z}), scale = longest > 0 ? ((1 << 20) - 1) / longest : 0;
  std::vector<std::pair<std::uint64_t, std::int32_t>> keys(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint64_t key = 0;
    for (int a = 0; a < 3; ++a) key |= spread(std::uint64_t((points[i][a] - low[a]) * scale)) << a;
    keys[i] = {key, std::int32_t(i)};
  }
  // Runs are sorted side by side, then merged in pairs.
  std::size_t run = std::max<std::size_t>(1, (keys.size() + 7) / 8);
  const auto at = [&](std::size_t i) { return keys.begin() + std::ptrdiff_t(std::min(i, keys.size())); };
  parallelFor(8, [&](std::size_t r) { std::sort(at(r * run), at((r + 1) * run)); });
  for (int runs = 8; runs > 1; runs /= 2, run *= 2)
    parallelFor(std::size_t(runs) / 2, [&](std::size_t r) { std::inplace_merge(at(2 * r * run), at((2 * r + 1) * run), at((2 * r + 2) * run)); });
  std::vector<std::int32_t> order(points.size());
  for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].second;
  return order;
}

SurfaceTree::SurfaceTree(const Mesh& mesh) {
  for (const auto& t : mesh.triangles)
    for (int corner : t) {
      const bool exists = corner >= 0 && std::size_t(corner) < mesh.points.size();
      if (!exists || !isFinite(mesh.points[corner]))
        throw Error("the mesh has a triangle with a corner that does not exist or is not finite")
            .given(std::to_string(corner)).advise("Export it again, or repair it");
      const Vec3 p = mesh.points[corner];
      if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > TriangleBvh::kHuge)
        throw Error("the mesh has a coordinate beyond any body").given(std::to_string(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)})) + " mm")
            .advise("Check the units, or repair it");
    }
  parallelFor(2, [&](std::size_t part) { part == 0 ? void(bvh_.emplace(mesh)) : void(topology_.emplace(mesh)); });
  if (bvh_->empty()) throw Error("the mesh has no triangle with an area, so nothing can be measured against it").advise("Give a surface of triangles");
}

ClosestPoint SurfaceTree::closestOn(int triangle, Vec3 p) const {
  const auto& t = topology_->corners(triangle);
  return closestOnTriangle(p, topology_->point(t[0]), topology_->point(t[1]), topology_->point(t[2]));
}

SurfaceHit SurfaceTree::hitAt(int triangle, const ClosestPoint& found, Vec3 p) const {
  const double side = dot(p - found.point, topology_->pseudonormal(triangle, found.feature));
  const double length = pectora::distance(p, found.point);
  return {side < 0 ? -length : length, found.point, triangle, found.feature, topology_->isBorder(triangle, found.feature)};
}

// An upper bound only: the search finds the triangle again, or a nearer one.
NearestTriangle SurfaceTree::beginAt(int triangle, Vec3 p) const {
  if (triangle < 0) return {};
  const Vec3 d = p - closestOn(triangle, p).point;
  return {dot(d, d) * (1 + 1e-9) + 1e-18, -1};
}

SurfaceHit SurfaceTree::find(Vec3 p, const TriangleBvh::Start& start, NearestTriangle best) const {
  bvh_->search(p, start, best);
  if (best.triangle < 0) bvh_->search(p, bvh_->root(), best = {});   // the bound was lost in rounding: far away, or nearly touching
  return hitAt(best.triangle, closestOn(best.triangle, p), p);
}

SurfaceHit SurfaceTree::closest(Vec3 p, int near) const { return find(p, bvh_->root(), beginAt(near, p)); }

void SurfaceTree::closestInTurn(std::span<const Vec3> points, std::span<SurfaceHit> hits) const {
  constexpr std::size_t kGroup = 16;
  int near = -1;
  for (std::size_t first = 0; first < points.size(); first += kGroup) {
    const std::size_t end = std::min(points.size(), first + kGroup);
    // A ball that holds the closest points of the whole group.
    const Vec3 center = points[first];
    TriangleBvh::Start start = bvh_->root();
    if (near >= 0) {
      double radius = 0;
      for (std::size_t i = first; i < end; ++i) radius = std::max(radius, distance(points[i], center));
      radius = 2 * radius + std::sqrt(beginAt(near, center).squared);
      start = bvh_->startFor(center, radius * (1 + 1e-9));
    }
    for (std::size_t i = first; i < end; ++i) {
      const int begin = hits[i].triangle >= 0 ? hits[i].triangle : near;
      hits[i] = find(points[i], start, beginAt(begin, points[i]));
      near = hits[i].triangle;
    }
  }
}

SurfaceHit SurfaceTree::closestNearby(Vec3 p, int start) const {
  const auto squared = [&](const ClosestPoint& c) { return dot(p - c.point, p - c.point); };
  int triangle = start;
  ClosestPoint found = closestOn(start, p);
  for (int last = -1; triangle != last && found.feature != Feature::face;) {
    last = triangle;
    // A point on an edge or corner: the others that meet there may come nearer.
    const auto& corners = topology_->corners(last);
    const int k = int(found.feature) % 3;
    for (int t : topology_->trianglesAt(corners[k])) {
      const ClosestPoint other = closestOn(t, p);
      if (squared(other) < squared(found)) found = other, triangle = t;
    }
  }
  return hitAt(triangle, found, p);
}

std::vector<SurfaceHit> SurfaceTree::closest(const std::vector<Vec3>& points, const std::function<void(double)>& poll) const {
  const std::vector<std::int32_t> order = spatialOrder(points);
  std::vector<SurfaceHit> found(points.size());
  constexpr std::size_t kBlock = 1024, kRound = 128;
  const std::size_t blocks = (points.size() + kBlock - 1) / kBlock;
  // In rounds, so that progress and cancel are seen between them.
  for (std::size_t first = 0; first < blocks; first += kRound) {
    poll(double(first) / double(blocks));
    parallelFor(std::min(kRound, blocks - first), [&](std::size_t b) {
      const std::size_t begin = (first + b) * kBlock, count = std::min(points.size() - begin, kBlock);
      std::array<Vec3, kBlock> near;
      std::array<SurfaceHit, kBlock> hits;
      for (std::size_t i = 0; i < count; ++i) near[i] = points[order[begin + i]];
      closestInTurn({near.data(), count}, {hits.data(), count});
      for (std::size_t i = 0; i < count; ++i) found[order[begin + i]] = hits[i];
    });
  }
  return found;
}

}  // namespace pectora
