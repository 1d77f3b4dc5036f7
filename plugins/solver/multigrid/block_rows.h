// The inner loops of a grid matrix: products with the blocks of one row. Each does the same arithmetic in every lane, so that
// its bits are the same for every instruction set.
#pragma once

#include "kernel/physics/rows.h"

namespace pectora {

/// Blocks of one row: entry (i, j) of the block of column c is entries[(3 i + j) * stride + c].
struct BlockRow {
  const float* entries;
  std::size_t stride;
};
/// y += A x, column by column; `transposed`: y += A^T x.
void addBlockProducts(std::size_t count, BlockRow a, bool transposed, ConstRow<float> x, Row<float> y);

/// Symmetric blocks, in the order xx xy xz yy yz zz: y = A x.
void setSymmetricProducts(std::size_t count, BlockRow a, ConstRow<float> x, Row<float> y);

}  // namespace pectora
