// From a grid to the next coarser one, which has every second row and column: values between are interpolated linearly (P), and the
// coarse matrix is P^T A P (Galerkin).
#pragma once

#include "plugins/solver/multigrid/grid_matrix.h"

namespace pectora {

/// The grid below: about half the rows and columns, until there are but a few.
GridShape coarser(GridShape fine);

/// coarse = P^T fine.
void restrict(GridShape fineShape, const SingleVectors& fine, GridShape coarseShape, SingleVectors& coarse);
/// fine += P coarse.
void prolongate(GridShape coarseShape, const SingleVectors& coarse, GridShape fineShape, SingleVectors& fine);

/// Sums a fine matrix into P^T A P.
class Collector {
 public:
  Collector(GridShape fine, GridMatrix& coarse) : fine_(fine), coarse_(coarse) {}
  /// A block beside the diagonal, with its transpose; left out if a node lies beyond the grid.
  void coupling(std::size_t a, std::size_t b, const Matrix3& block);
  /// The same for blocks of (a + i, b + i), which lie in one row: entry (j, k) of block i at entries[3 j + k][i]. Of equal a and b, give
  /// half. Runs in rows that two others part may be added by several threads at once.
  void run(std::size_t a, std::size_t b, std::size_t count, const float* const entries[9], float weight = 1);
  /// All of a finer matrix.
  void add(const GridMatrix& fine);

 private:
  GridShape fine_;
  GridMatrix& coarse_;
};

}  // namespace pectora
