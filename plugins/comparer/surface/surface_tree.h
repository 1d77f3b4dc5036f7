// Signed distance to a triangle mesh: a bounding volume hierarchy and angle-weighted pseudonormals
// (Baerentzen and Aanaes, IEEE TVCG 2005), right also on open sheets.
#pragma once

#include "plugins/comparer/surface/closest.h"

#include "kernel/value/mesh.h"

#include <cstdint>

namespace pectora {

struct SurfaceHit {
  double distance = 0;      ///< mm; positive on the side that the triangles' normals point to
  Vec3 point;               ///< closest point of the surface
  int triangle = -1;
  bool onBorder = false;    ///< the closest point lies on an open edge: the sample has no true counterpart
};

class SurfaceTree {
 public:
  /// Keeps a copy of what it needs. Throws Error if the mesh has no triangle with an area, or bad indices or coordinates.
  explicit SurfaceTree(const Mesh& mesh);
  SurfaceHit closest(Vec3 p) const;

 private:
  struct Node {
    float low[3], high[3];
    std::int32_t left = -1;    // children are left and right; a leaf has left < 0
    std::int32_t right = -1;
    std::int32_t first = 0, count = 0;
  };
  struct Triangle {
    Vec3 a, b, c;
    std::int32_t id;
  };
  int build(int begin, int end, const std::vector<Vec3>& centers);
  void computeNormals(const Mesh& mesh);

  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;                  // in leaf order
  std::vector<std::int32_t> order_;
  std::vector<std::array<Vec3, 7>> pseudonormals_;   // per triangle and Feature
  std::vector<std::array<bool, 7>> border_;
};

}  // namespace pectora
