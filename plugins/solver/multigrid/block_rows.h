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

/// Both at once: nearOut += A farIn and farOut += A^T nearIn, which share nothing.
void addBlockProducts(std::size_t count, BlockRow a, ConstRow<float> nearIn, ConstRow<float> farIn, Row<float> nearOut, Row<float> farOut);

/// Symmetric blocks, in the order xx xy xz yy yz zz: y = A x.
void setSymmetricProducts(std::size_t count, BlockRow a, ConstRow<float> x, Row<float> y);

/// to[i] += weight * from[i], and the same of every second `from`: to[i] += weight * from[2 i].
void addScaled(std::size_t count, const float* from, float weight, float* to);
void addEverySecond(std::size_t count, const float* from, float weight, float* to);

}  // namespace pectora
