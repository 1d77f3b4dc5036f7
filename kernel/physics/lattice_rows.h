// The inner loops of the lattice: all springs of one stencil entry that start in one row. Each loop runs along the columns
// and does the same arithmetic in every lane, so that its bits are the same for every instruction set.
#pragma once

#include "kernel/physics/rows.h"

namespace pectora::lattice {

/// A spring shorter than this part of its rest length has no direction of its own.
inline constexpr double kDegenerate = 1e-12;

/// The springs of one row: near end i, far end i, for i below count, where they are now, or of a second derivative how far they have
/// moved from rest; and at rest. Rest lengths are the distances at rest; to compute them costs less than to read them.
template <class T>
struct RowSprings {
  std::size_t count;
  ConstRow<T> near, far, restNear, restFar;
  T stiffness, compression;
};

/// What a row adds up, column by column: twice the energy, the largest force, and 1 where a spring has no direction.
struct RowSums {
  double *twiceEnergy, *largest, *degenerate;
};

/// Subtracts the forces on the near ends from `gradient`; those on the far ends are opposite, and written to `pull`. A degenerate
/// spring gets none.
void springForces(const RowSprings<double>& springs, Row<double> gradient, Row<double> pull, RowSums sums);
/// The energy alone.
void springEnergies(const RowSprings<double>& springs, double* twiceEnergy);
/// target += source.
void addRow(std::size_t count, ConstRow<double> source, Row<double> target);
void addRow(std::size_t count, ConstRow<float> source, Row<float> target);
void addRow(std::size_t count, ConstRow<float> source, Row<double> target);
/// target = a - b.
void subtractRows(std::size_t count, ConstRow<double> a, ConstRow<double> b, Row<float> target);

/// A spring shorter than this part of its rest length has no direction of its own in single precision.
inline constexpr float kDegenerateSingle = 1e-5f;

/// Second derivative of a row's springs: H = a I + b d d^T with d = far - near, a = k (1 - l0 / l), not below 0 if projected, and
/// b = (k - a) / l^2. Written is -H, which joins the ends, as xx xy xz yy yz zz. A degenerate spring gets 0; returns whether there is
/// one. Single precision: it only steers a solver.
bool springBlocks(const RowSprings<float>& springs, bool projected, float* const blocks[6]);
/// pull = H (vFar - vNear), and `product` of the near ends is less by it. A degenerate spring gives none; returns whether there is one.
bool curvatureProducts(const RowSprings<float>& springs, bool projected, ConstRow<float> vNear, ConstRow<float> vFar, Row<float> product,
                       Row<float> pull);

}  // namespace pectora::lattice
