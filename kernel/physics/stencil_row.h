// The inner loop of the lattice in single precision: all springs that start in one row at once, sixteen columns side by side, so that a
// near end is read and written once for all its springs. The bits are the same for every instruction set.
#pragma once

#include "kernel/physics/rows.h"

#include <vector>

namespace pectora::lattice {

/// Columns that are computed side by side.
inline constexpr std::size_t kChunk = 16;
/// What lies at rest beyond the columns of a row; a spring to it is of no stiffness, but has a length.
inline constexpr float kBeyond = 1e6f;

/// The springs of one stencil entry in a row. Those next to each other in the list should end in different rows: sums that were just
/// written are slow to be read again a column aside.
struct RowEntry {
  std::ptrdiff_t far;           ///< from the near end to the far one, in numbers
  std::ptrdiff_t first, end;    ///< columns in which it starts
  float stretched, compressed;  ///< stiffness, N/mm
};

/// One row, and what is added up. All rows of numbers are given at column 0 of the near ends; beyond the columns, up to a full chunk and as
/// far as springs reach, they hold what may be written over: kBeyond in `rest`, anything finite in `moved`.
struct StencilRow {
  std::size_t columns;
  const RowEntry *entries, *entriesEnd;
  ConstRow<float> moved, rest;              ///< where all ends have moved from rest, and were there, mm
  Row<float> gradient;                      ///< the forces on both ends are subtracted, N
  float *twiceEnergy, *largestSquared;      ///< of each column, in whole chunks: N mm and N^2; added to, and raised
};

/// Does it with the widest registers that this machine has. Forces are right to about 1e-6 of themselves, however small, as lengths grow by
/// what their ends have moved. Returns whether a spring has no direction (kDegenerateSingle); then what was added is no use.
bool addRowForces(const StencilRow& row);
/// The same for each width of registers that this machine has, the widest first.
std::vector<bool (*)(const StencilRow&)> rowForcesByWidth();

}  // namespace pectora::lattice
