// The inner loops of the cells' Hessian.
#pragma once

#include "plugins/effect/common/cell_pack.h"

namespace pectora::cells {

/// A node's entries: the six of its own symmetric block (xx, xy, xz, yy, yz, zz), then nine (row by row) for each neighbour
/// that comes after it, in the order of kNeighbours.
inline constexpr int kNeighbourCount = 13, kEntries = 6 + 9 * kNeighbourCount;
/// Steps of layer, row and column.
inline constexpr int kNeighbours[kNeighbourCount][3] = {{0, 0, 1},  {0, 1, -1}, {0, 1, 0},  {0, 1, 1}, {1, -1, -1}, {1, -1, 0}, {1, -1, 1},
                                                        {1, 0, -1}, {1, 0, 0},  {1, 0, 1},  {1, 1, -1}, {1, 1, 0},  {1, 1, 1}};

/// Adds the blocks of a pack's cells to the entries at its corners: entry e of the node in row k, column bit b and lane i is
/// rows[k][e * stride + b + i]. `projected`: of every point of quadrature the nearest semi-definite form.
void addCurvatures(const Run& run, const RestPack& rest, bool projected, float* const (&rows)[4], std::size_t stride);

/// near += K far and far += K^T near for `count` pairs of nodes and their nine entries; `sum` takes the first.
void blockProducts(std::size_t count, const float* entries, std::size_t stride, ConstRow<double> near, ConstRow<double> far, Row<double> sum, Row<double> farSum);
/// sum += K v for the symmetric blocks.
void diagonalProducts(std::size_t count, const float* entries, std::size_t stride, ConstRow<double> v, Row<double> sum);

}  // namespace pectora::cells
