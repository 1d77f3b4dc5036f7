// The inner loops of the cells: energy and forces of a pack.
#pragma once

#include "plugins/effect/common/cell_pack.h"

namespace pectora::cells {

/// Rows of the gradient at the same corners as Run::rows.
struct ForceRows {
  double* rows[3][4];
};

/// Energy of the pack's cells together, N mm.
double cellEnergy(const Run& run, const RestPack& rest);
/// The same; adds dE/dx to `forces` and raises `largestSquared` to the square of the largest force of a cell on a corner.
double cellForces(const Run& run, const RestPack& rest, const ForceRows& forces, double& largestSquared);

}  // namespace pectora::cells
