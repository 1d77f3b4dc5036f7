// Statistics of the signed distances from one surface's points to another.
#pragma once

#include "kernel/value/comparison.h"

#include <functional>

namespace pectora {

struct CompareSettings {
  std::string name = "comparison";
  double maxDistance = 40;      ///< points further away have no counterpart, mm
  double pitThreshold = 3;      ///< the pit is where "unchanged" and reference differ by more than this, mm
  double pitMargin = 10;        ///< and what lies within this of it, mm
  double binWidth = 0.5;        ///< of the histogram, mm
};

/// Signed distances from the points of `sample` (Mesh or Points) to `reference`. With `unchanged` (the surface before), the pit region and the
/// baseline "nothing changed" are computed too: the same points against that surface. `poll` is called now and then with the fraction done.
/// Points whose nearest counterpart lies on the reference's border, or too far away, are excluded.
Comparison compareSurfaces(std::shared_ptr<const Value> sample, const Mesh& reference, const Mesh* unchanged,
                           const CompareSettings& settings, const std::function<void(double)>& poll);

}  // namespace pectora
