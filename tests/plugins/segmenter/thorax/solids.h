// Small volumes with simple bodies, drawn with partial volume at their edges.
#pragma once

#include "kernel/value/volume.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

namespace solids {

using pectora::Vec3;

/// Air of that size; positions are LPS mm with the first voxel at the origin.
inline std::shared_ptr<pectora::Volume> air(std::array<int, 3> size, Vec3 spacing) {
  auto ct = std::make_shared<pectora::Volume>();
  ct->grid.size = size;
  ct->grid.spacing = spacing;
  ct->hu.assign(ct->grid.voxels(), -1000);
  return ct;
}

/// Fills where `distance` (mm, negative inside) says so; across the edge the value goes over linearly within one voxel.
inline void fill(pectora::Volume& ct, double hu, const std::function<double(Vec3)>& distance) {
  const double edge = std::min(ct.grid.spacing.x, ct.grid.spacing.y);
  std::size_t n = 0;
  for (int k = 0; k < ct.grid.size[2]; ++k)
    for (int j = 0; j < ct.grid.size[1]; ++j)
      for (int i = 0; i < ct.grid.size[0]; ++i, ++n) {
        const Vec3 p{i * ct.grid.spacing.x, j * ct.grid.spacing.y, k * ct.grid.spacing.z};
        const double share = std::clamp(0.5 - distance(p) / edge, 0.0, 1.0);
        if (share > 0) ct.hu[n] = std::int16_t(std::lround(ct.hu[n] + share * (hu - ct.hu[n])));
      }
}

/// Cylinder along z with an elliptic section; the distance is of first order.
inline std::function<double(Vec3)> cylinder(double x, double y, double a, double b) {
  return [=](Vec3 p) {
    const double u = (p.x - x) / a, v = (p.y - y) / b, r = std::hypot(u, v);
    const double slope = r > 0 ? std::hypot(u / a, v / b) / r : 1 / std::min(a, b);
    return (r - 1) / slope;
  };
}

}  // namespace solids
