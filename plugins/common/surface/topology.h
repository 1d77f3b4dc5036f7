// Which triangles meet at each point of a mesh, and the pseudonormals that follow from it.
#pragma once

#include "plugins/common/surface/closest.h"

#include "kernel/value/mesh.h"

#include <cstdint>
#include <span>

namespace pectora {

/// Triangles around each point, in the mesh's order. All indices of the mesh must be good.
class Topology {
 public:
  explicit Topology(const Mesh& mesh);

  Vec3 point(int index) const { return points_[index]; }
  const std::array<int, 3>& corners(int triangle) const { return triangles_[triangle]; }

  std::span<const std::int32_t> trianglesAt(int point) const {
    return {list_.data() + start_[point], std::size_t(start_[point + 1] - start_[point])};
  }
  /// Whether exactly one triangle has this edge.
  bool isBorderEdge(int a, int b) const;
  /// Whether a border edge ends in the point.
  bool isBorderPoint(int point) const;

  /// The pseudonormal of a triangle's feature (Baerentzen and Aanaes, IEEE TVCG 2005): of its face, the sum over an edge's faces, or
  /// the sum over a corner's faces weighted by their angles. Not of unit length; zero where no face has an area.
  Vec3 pseudonormal(int triangle, Feature feature) const;
  /// Whether the feature lies on an open edge.
  bool isBorder(int triangle, Feature feature) const;

 private:
  Vec3 faceNormal(int triangle) const;

  std::vector<Vec3> points_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::int32_t> start_, list_;
};

}  // namespace pectora
