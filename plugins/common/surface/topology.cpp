#include "plugins/common/surface/topology.h"

namespace pectora {
namespace {

double angleBetween(Vec3 u, Vec3 v) { return std::atan2(norm(cross(u, v)), dot(u, v)); }

bool hasCorner(const std::array<int, 3>& t, int point) { return t[0] == point || t[1] == point || t[2] == point; }

// The two ends of a triangle's edge feature.
std::pair<int, int> endsOf(const std::array<int, 3>& t, Feature edge) {
  const int k = int(edge) - int(Feature::edgeAB);
  return {t[k], t[(k + 1) % 3]};
}

}  // namespace

Topology::Topology(const Mesh& mesh) : points_(mesh.points), triangles_(mesh.triangles), start_(mesh.points.size() + 1), list_(3 * mesh.triangles.size()) {
  for (const auto& t : triangles_)
    for (int corner : t) ++start_[corner + 1];
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  std::vector<std::int32_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < triangles_.size(); ++i)
    for (int corner : triangles_[i]) list_[next[corner]++] = std::int32_t(i);
}

Vec3 Topology::faceNormal(int triangle) const {
  const auto& t = triangles_[triangle];
  return normalized(cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]));
}

bool Topology::isBorderEdge(int a, int b) const {
  int faces = 0;
  for (int t : trianglesAt(a)) faces += hasCorner(triangles_[t], b);
  return faces == 1;
}

bool Topology::isBorderPoint(int point) const {
  for (int t : trianglesAt(point))
    for (int corner : triangles_[t])
      if (corner != point && isBorderEdge(point, corner)) return true;
  return false;
}

Vec3 Topology::pseudonormal(int triangle, Feature feature) const {
  if (feature == Feature::face) return faceNormal(triangle);
  Vec3 sum;
  if (feature >= Feature::edgeAB) {
    const auto [a, b] = endsOf(triangles_[triangle], feature);
    for (int t : trianglesAt(a))
      if (hasCorner(triangles_[t], b)) sum += faceNormal(t);
    return sum;
  }
  const int point = triangles_[triangle][int(feature)];
  for (int t : trianglesAt(point)) {
    const auto& c = triangles_[t];
    const int k = c[0] == point ? 0 : c[1] == point ? 1 : 2;
    const Vec3 here = points_[point];
    sum += faceNormal(t) * angleBetween(points_[c[(k + 1) % 3]] - here, points_[c[(k + 2) % 3]] - here);
  }
  return sum;
}

bool Topology::isBorder(int triangle, Feature feature) const {
  if (feature == Feature::face) return false;
  if (feature < Feature::edgeAB) return isBorderPoint(triangles_[triangle][int(feature)]);
  const auto [a, b] = endsOf(triangles_[triangle], feature);
  return isBorderEdge(a, b);
}

}  // namespace pectora
