// Statistics of the signed distances between two surfaces.
#pragma once

#include "plugins/comparer/surface/regions.h"

#include "kernel/value/comparison.h"

#include <functional>

namespace pectora {

struct CompareSettings {
  std::string name = "comparison";
  double maxDistance = 40;      ///< points further away have no counterpart, mm
  double pitThreshold = 3;      ///< the pit is where "unchanged" and reference differ by more than this, the hollow where "unchanged" lies
                                ///< deeper than this behind its own front, mm
  double pitMargin = 10;        ///< and what lies within this of them, mm
  double binWidth = 0.5;        ///< of the histogram, mm
  bool isPaper = false;         ///< as the paper: every point counts, also beyond borders and however far
  bool bothWays = true;         ///< also from the reference to the sample, if that is a mesh
  std::vector<Region> regions;
};

/// The surfaces that a sample is measured against.
struct Surfaces {
  const Mesh& reference;
  const Mesh* unchanged = nullptr;   ///< the surface before: for pit and hollow, and the baseline "nothing changed"
  const Mesh* copied = nullptr;      ///< the surface if the skin moved as the bone below it: the other baseline
};

/// Signed distances from the points of `sample` (Mesh or Points) to the reference, and back. A point takes part if it has a
/// counterpart on every surface (not on its border, not too far), so that comparison and baselines see the same points.
/// The sample comes back with the fields "distance" (mm, NaN where it takes no part), "left_out" (0: takes part, 1: beyond a
/// border, 2: too far) and, with `unchanged`, "pit" and "hollow" (0 or 1) and "unchanged_distance" (mm).
/// `poll` is called now and then with the fraction done, and may throw.
Comparison compareSurfaces(std::shared_ptr<const Value> sample, const Surfaces& surfaces, const CompareSettings& settings,
                           const std::function<void(double)>& poll);

}  // namespace pectora
