// From a scanned cloud to a surface of triangles.
#pragma once

#include "kernel/value/mesh.h"

#include <functional>

namespace pectora {

struct ReconstructSettings {
  double noise = 0;     ///< standard deviation of the points along their normals, mm; 0: estimated from their neighbourhoods
  double cell = 2;      ///< side of the triangles, about, mm
  double fill = 10;     ///< holes that are nowhere further than this from a point are filled, others stay open; mm
};

struct Reconstruction {
  Mesh mesh;
  double spacing = 0;            ///< of the points, median, mm
  double noise = 0;              ///< given or estimated, mm
  std::size_t balls = 0;         ///< local fits
  bool estimatedNormals = false;
};

/// Points must be finite, and 100 or more. Normals (unit, outward) may be empty: then they are estimated. Throws Error if no surface comes out.
/// `poll` is called with the fraction done, and may throw.
Reconstruction reconstruct(const std::vector<Vec3>& points, const std::vector<Vec3>& normals, const ReconstructSettings& settings,
                           const std::function<void(double)>& poll);

}  // namespace pectora
