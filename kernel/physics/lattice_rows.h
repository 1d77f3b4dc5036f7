// The inner loops of the lattice: all springs of one stencil entry that start in one row. Each loop runs along the columns
// and does the same arithmetic in every lane, so that its bits are the same for every instruction set.
#pragma once

#include <cstddef>

namespace pectora::lattice {

/// A spring shorter than this part of its rest length has no direction of its own.
inline constexpr double kDegenerate = 1e-12;

struct ConstRow {
  const double *x, *y, *z;
};
struct Row {
  double *x, *y, *z;
};

/// The springs of one row: near end i, far end i, for i below count.
struct RowSprings {
  std::size_t count;
  ConstRow near, far;
  const double* restLength;
  double stiffness, compression;
};

/// What a row adds up, column by column: twice the energy, the largest force, and 1 where a spring has no direction.
struct RowSums {
  double *twiceEnergy, *largest, *degenerate;
};

/// Forces on the near ends; those on the far ends are opposite. A degenerate spring gets none. `pull` is overwritten.
void springForces(const RowSprings& springs, Row pull, RowSums sums);
/// The energy alone.
void springEnergies(const RowSprings& springs, double* twiceEnergy);
/// target += sign * source.
void addRow(std::size_t count, ConstRow source, double sign, Row target);

/// Second derivative of a row's springs: a I + m m^T with m = sqrt(b) n. Single precision: it only steers a solver, and
/// stays exactly symmetric and, where projected, semi-definite.
struct RowCurvature {
  float *mx, *my, *mz, *a;
};
/// a = k (1 - l0 / l), not below 0 if projected; b = k - a. A degenerate spring gets a = b = 0.
void springCurvatures(const RowSprings& springs, bool projected, RowCurvature curvature, double* degenerate);
/// pull = H (far - near).
void curvatureProducts(std::size_t count, ConstRow near, ConstRow far, RowCurvature curvature, Row pull);

}  // namespace pectora::lattice
