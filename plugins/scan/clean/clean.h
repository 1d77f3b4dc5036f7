// Takes out of a scanned cloud what is no skin.
#pragma once

#include "kernel/value/mesh.h"

#include <functional>

namespace pectora {

struct CleanSettings {
  double duplicateDistance = 0.01;   ///< of points nearer together than this one stays, mm
  int neighbours = 16;               ///< of a point, for what is usual around it
  double outlierFactor = 4;          ///< a point is an outlier if its mean distance to them is this many robust standard deviations above the median; 0: none is
  bool estimateNormals = true;       ///< where the scan has none
};

/// What was taken out, and why.
struct Cleaned {
  Points points;
  std::size_t notFinite = 0, duplicates = 0, outliers = 0;
  bool estimatedNormals = false;
};

/// Keeps the order of the points, with their normals and sweeps; fields are left behind. Throws Error if fewer than 4 points stay.
Cleaned clean(const Points& scan, const CleanSettings& settings, const std::function<void(double)>& poll);

}  // namespace pectora
