// The closest point of a triangle (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
#pragma once

#include "kernel/value/vec3.h"

#include <array>

namespace pectora {

/// Which part of a triangle (a, b, c) holds a point: a corner 0-2, an edge 3 (ab), 4 (bc), 5 (ca), or 6: the inside.
enum class Feature { cornerA, cornerB, cornerC, edgeAB, edgeBC, edgeCA, face };

struct ClosestPoint {
  Vec3 point;
  Feature feature = Feature::face;
};

/// Exact for triangles of any shape; one without area counts as its longest edge.
ClosestPoint closestOnTriangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

}  // namespace pectora
