#include "plugins/solver/multigrid/grid_matrix.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace pectora {
namespace {

constexpr int kUsualReach = 2;

}  // namespace

GridMatrix::GridMatrix(GridShape shape)
    : shape_(shape), diagonal_(std::size_t(shape.layers), std::vector<float>(6 * std::size_t(shape.rows) * shape.columns)), inverse_(diagonal_) {
  widen(kUsualReach);
}

void GridMatrix::widen(int reach) {
  reach_ = reach;
  index_.assign(std::size_t(shape_.layers) * shape_.layers * (reach_ + 1) * (2 * reach_ + 1), -1);
  for (std::size_t i = 0; i < offsets_.size(); ++i)
    index_[indexOf(offsets_[i].layer, offsets_[i].otherLayer, offsets_[i].rows, offsets_[i].columns)] = int(i);
}

GridMatrix::Offset& GridMatrix::offset(int layer, int otherLayer, int rows, int columns) {
  if (std::max(rows, std::abs(columns)) > reach_) widen(std::max(rows, std::abs(columns)));
  int& index = index_[indexOf(layer, otherLayer, rows, columns)];
  if (index < 0) {
    index = int(offsets_.size());
    offsets_.push_back({layer, otherLayer, rows, columns, std::vector<float>(9 * std::size_t(shape_.rows) * shape_.columns)});
  }
  return offsets_[std::size_t(index)];
}

void GridMatrix::addDiagonal(std::size_t point, const Symmetric3& block, double weight) {
  const std::size_t stride = std::size_t(shape_.columns), layer = stride * shape_.rows;
  const int row = int(point % layer / stride), column = int(point % stride);
  float* d = &diagonal_[point / layer][place(row, column, 6)];
  const double values[6] = {block.xx, block.xy, block.xz, block.yy, block.yz, block.zz};
  for (int e = 0; e < 6; ++e) d[std::size_t(e) * stride] += float(weight * values[e]);
}

void GridMatrix::addCoupling(std::size_t a, std::size_t b, const Matrix3& block, double weight) {
  const std::size_t stride = std::size_t(shape_.columns), layer = stride * shape_.rows;
  int la = int(a / layer), lb = int(b / layer), row = int(a % layer / stride), column = int(a % stride);
  int rows = int(b % layer / stride) - row, columns = int(b % stride) - column;
  // A pair is kept with the end that comes first.
  const bool turned = rows < 0 || (rows == 0 && (columns < 0 || (columns == 0 && la > lb)));
  if (turned) {
    row += rows, column += columns;
    rows = -rows, columns = -columns;
    std::swap(la, lb);
  }
  float* m = &offset(la, lb, rows, columns).blocks[place(row, column, 9)];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m[std::size_t(3 * i + j) * stride] += float(weight * (turned ? block.m[j][i] : block.m[i][j]));
}

void GridMatrix::finish() {
  const std::size_t stride = std::size_t(shape_.columns);
  for (std::size_t l = 0; l < diagonal_.size(); ++l)
    parallelFor(std::size_t(shape_.rows), [&](std::size_t r) {
      for (int c = 0; c < shape_.columns; ++c) {
        const float* d = &diagonal_[l][place(int(r), c, 6)];
        float* i = &inverse_[l][place(int(r), c, 6)];
        const Symmetric3 inverted = inverse({double(d[0]), double(d[stride]), double(d[2 * stride]), double(d[3 * stride]),
                                             double(d[4 * stride]), double(d[5 * stride])});
        i[0] = float(inverted.xx), i[stride] = float(inverted.xy), i[2 * stride] = float(inverted.xz);
        i[3 * stride] = float(inverted.yy), i[4 * stride] = float(inverted.yz), i[5 * stride] = float(inverted.zz);
      }
    });
}

// Every row gathers: from the blocks that start in it, and, transposed, from those that end in it.
void GridMatrix::multiply(const SingleVectors& x, SingleVectors& y) const {
  const std::size_t columns = std::size_t(shape_.columns);
  parallelFor(std::size_t(shape_.rows), [&](std::size_t r) {
    const int row = int(r);
    for (int l = 0; l < shape_.layers; ++l)
      setSymmetricProducts(columns, {&diagonal_[std::size_t(l)][place(row, 0, 6)], columns}, rowOf(x, shape_.number(l, row, 0)),
                           rowOf(y, shape_.number(l, row, 0)));
    for (const Offset& o : offsets_) {
      const int first = std::max(0, -o.columns), end = std::min(shape_.columns, shape_.columns - o.columns);
      if (first >= end) continue;
      const std::size_t count = std::size_t(end - first);
      if (row + o.rows < shape_.rows)
        addBlockProducts(count, {&o.blocks[place(row, first, 9)], columns}, false,
                         rowOf(x, shape_.number(o.otherLayer, row + o.rows, first + o.columns)), rowOf(y, shape_.number(o.layer, row, first)));
      if (row - o.rows >= 0)
        addBlockProducts(count, {&o.blocks[place(row - o.rows, first, 9)], columns}, true,
                         rowOf(x, shape_.number(o.layer, row - o.rows, first)), rowOf(y, shape_.number(o.otherLayer, row, first + o.columns)));
    }
  });
}

void GridMatrix::multiplyInverseDiagonal(const SingleVectors& x, SingleVectors& y) const {
  const std::size_t columns = std::size_t(shape_.columns);
  parallelFor(std::size_t(shape_.rows), [&](std::size_t row) {
    for (int l = 0; l < shape_.layers; ++l)
      setSymmetricProducts(columns, {&inverse_[std::size_t(l)][place(int(row), 0, 6)], columns}, rowOf(x, shape_.number(l, int(row), 0)),
                           rowOf(y, shape_.number(l, int(row), 0)));
  });
}

}  // namespace pectora
