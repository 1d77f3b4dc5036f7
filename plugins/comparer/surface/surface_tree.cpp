#include "plugins/comparer/surface/surface_tree.h"

#include "kernel/stage/error.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace pectora {
namespace {

constexpr int kLeafSize = 4;

std::uint64_t edgeKey(int a, int b) {
  if (a > b) std::swap(a, b);
  return std::uint64_t(std::uint32_t(a)) << 32 | std::uint32_t(b);
}

double boxDistanceSquared(const float low[3], const float high[3], Vec3 p) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = std::max({double(low[a]) - p[a], 0.0, p[a] - double(high[a])});
    sum += d * d;
  }
  return sum;
}

double angleBetween(Vec3 u, Vec3 v) { return std::atan2(norm(cross(u, v)), dot(u, v)); }

}  // namespace

SurfaceTree::SurfaceTree(const Mesh& mesh) {
  const int count = int(mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (int corner : t)
      if (corner < 0 || std::size_t(corner) >= mesh.points.size() || !isFinite(mesh.points[corner]))
        throw Error("the mesh has a triangle with a corner that does not exist or is not finite")
            .given(std::to_string(corner)).advise("Export it again, or repair it");
  std::vector<Vec3> centers(count);
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0);
  bool hasArea = false;
  for (int i = 0; i < count; ++i) {
    const auto& t = mesh.triangles[i];
    const Vec3 a = mesh.points[t[0]], b = mesh.points[t[1]], c = mesh.points[t[2]];
    centers[i] = (a + b + c) / 3;
    triangles_.push_back({a, b, c, i});
    hasArea = hasArea || norm(cross(b - a, c - a)) > 0;
  }
  if (!hasArea) throw Error("the mesh has no triangle with an area, so nothing can be measured against it").advise("Give a surface of triangles");
  computeNormals(mesh);
  nodes_.reserve(count);
  build(0, count, centers);
  std::vector<Triangle> sorted;
  sorted.reserve(count);
  for (int i : order_) sorted.push_back(triangles_[i]);
  triangles_ = std::move(sorted);
}

int SurfaceTree::build(int begin, int end, const std::vector<Vec3>& centers) {
  const int index = int(nodes_.size());
  nodes_.push_back({});
  Node node;
  Vec3 centerLow{INFINITY, INFINITY, INFINITY}, centerHigh{-INFINITY, -INFINITY, -INFINITY};
  std::fill(node.low, node.low + 3, INFINITY);
  std::fill(node.high, node.high + 3, -INFINITY);
  for (int i = begin; i < end; ++i) {
    const Triangle& t = triangles_[order_[i]];
    for (int a = 0; a < 3; ++a) {
      // Boxes are rounded outwards, so that no triangle is missed.
      const double low = std::min({t.a[a], t.b[a], t.c[a]}), high = std::max({t.a[a], t.b[a], t.c[a]});
      node.low[a] = std::min(node.low[a], std::nextafterf(float(low), -INFINITY));
      node.high[a] = std::max(node.high[a], std::nextafterf(float(high), INFINITY));
      centerLow[a] = std::min(centerLow[a], centers[order_[i]][a]);
      centerHigh[a] = std::max(centerHigh[a], centers[order_[i]][a]);
    }
  }
  node.first = begin;
  node.count = end - begin;
  if (end - begin > kLeafSize) {
    // Halve along the longest side of the centres.
    const Vec3 side = centerHigh - centerLow;
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    const int middle = (begin + end) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](int a, int b) { return centers[a][axis] != centers[b][axis] ? centers[a][axis] < centers[b][axis] : a < b; });
    node.left = build(begin, middle, centers);
    node.right = build(middle, end, centers);
  }
  nodes_[index] = node;
  return index;
}

void SurfaceTree::computeNormals(const Mesh& mesh) {
  // Faces; sums over edges; angle-weighted sums over vertices.
  std::vector<Vec3> faces(mesh.triangles.size()), vertices(mesh.points.size());
  struct Edge {
    Vec3 sum;
    int faces = 0;
  };
  std::unordered_map<std::uint64_t, Edge> edges;
  edges.reserve(mesh.triangles.size() * 2);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    faces[i] = normalized(cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]));
    for (int k = 0; k < 3; ++k) {
      const Vec3 here = mesh.points[t[k]];
      vertices[t[k]] += faces[i] * angleBetween(mesh.points[t[(k + 1) % 3]] - here, mesh.points[t[(k + 2) % 3]] - here);
      Edge& edge = edges[edgeKey(t[k], t[(k + 1) % 3])];
      edge.sum += faces[i];
      ++edge.faces;
    }
  }
  std::vector<bool> borderVertex(mesh.points.size());
  for (const auto& [key, edge] : edges)
    if (edge.faces == 1) borderVertex[key >> 32] = borderVertex[key & 0xffffffffu] = true;
  pseudonormals_.resize(mesh.triangles.size());
  border_.resize(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    for (int k = 0; k < 3; ++k) {
      const Edge& edge = edges.at(edgeKey(t[k], t[(k + 1) % 3]));
      pseudonormals_[i][k] = vertices[t[k]];
      pseudonormals_[i][3 + k] = edge.sum;
      border_[i][k] = borderVertex[t[k]];
      border_[i][3 + k] = edge.faces == 1;
    }
    pseudonormals_[i][6] = faces[i];
    border_[i][6] = false;
  }
}

SurfaceHit SurfaceTree::closest(Vec3 p) const {
  double best = INFINITY;
  ClosestPoint closest;
  int triangle = -1;
  struct Entry {
    int node;
    double distance;
  };
  Entry stack[128];
  int size = 0;
  stack[size++] = {0, boxDistanceSquared(nodes_[0].low, nodes_[0].high, p)};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.distance >= best) continue;
    const Node& node = nodes_[entry.node];
    if (node.left < 0) {
      for (int i = node.first; i < node.first + node.count; ++i) {
        const Triangle& t = triangles_[i];
        const ClosestPoint c = closestOnTriangle(p, t.a, t.b, t.c);
        const double d = dot(p - c.point, p - c.point);
        // Of equally near triangles the first in the mesh, whatever the tree's shape.
        if (d < best || (d == best && t.id < triangle)) best = d, closest = c, triangle = t.id;
      }
      continue;
    }
    Entry near{node.left, boxDistanceSquared(nodes_[node.left].low, nodes_[node.left].high, p)};
    Entry far{node.right, boxDistanceSquared(nodes_[node.right].low, nodes_[node.right].high, p)};
    if (far.distance < near.distance) std::swap(near, far);
    if (far.distance < best) stack[size++] = far;
    if (near.distance < best) stack[size++] = near;
  }
  const int feature = int(closest.feature);
  const double side = dot(p - closest.point, pseudonormals_[triangle][feature]);
  const double length = std::sqrt(best);
  return {side < 0 ? -length : length, closest.point, triangle, border_[triangle][feature]};
}

}  // namespace pectora
