// Normals of a cloud, and what its neighbourhoods say of its spacing and noise.
#pragma once

#include "plugins/scan/common/neighbours.h"

namespace pectora {

struct CloudNormals {
  std::vector<Vec3> normals;   ///< unit, outward
  double spacing = 0;          ///< median distance of a point to its nearest neighbour, mm
  double noise = 0;            ///< median standard deviation of the points about the plane of their neighbourhood, mm
};

/// Normals by the smallest principal axis of each point's `neighbours` nearest points, made consistent along the tree of least
/// change (Hoppe et al., SIGGRAPH 1992) from the point of each connected part that lies furthest from the centroid: there the
/// surface of a body faces outwards. Needs 4 points or more, finite.
CloudNormals estimateNormals(const std::vector<Vec3>& points, const Neighbours& tree, int neighbours = 24);

}  // namespace pectora
