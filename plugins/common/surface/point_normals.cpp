#include "plugins/common/surface/point_normals.h"

namespace pectora {

std::vector<Vec3> pointNormals(const Mesh& mesh) {
  std::vector<Vec3> normals(mesh.points.size());
  for (const auto& t : mesh.triangles) {
    const Vec3 n = cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
    for (int corner : t) normals[corner] += n;
  }
  for (Vec3& n : normals) n = normalized(n);
  return normals;
}

}  // namespace pectora
