// Normals of a mesh's points.
#pragma once

#include "kernel/value/mesh.h"

namespace pectora {

/// Unit normals, weighted by the triangles' areas; zero where no triangle has one. Indices must be good.
std::vector<Vec3> pointNormals(const Mesh& mesh);

}  // namespace pectora
