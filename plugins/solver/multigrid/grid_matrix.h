// A symmetric matrix of 3 x 3 blocks over the points of a grid of layers, in which a point is joined with its near neighbours
// only. Single precision: it only steers a solver.
#pragma once

#include "plugins/solver/multigrid/block_rows.h"

#include "kernel/physics/hessian.h"

#include <algorithm>
#include <vector>

namespace pectora {

/// Layers of rows x columns points. Point (l, r, c) has the number (l * rows + r) * columns + c.
struct GridShape {
  int layers = 0, rows = 0, columns = 0;
  std::size_t points() const { return std::size_t(layers) * rows * columns; }
  std::size_t number(int layer, int row, int column) const { return (std::size_t(layer) * rows + row) * columns + column; }
};

class GridMatrix {
 public:
  explicit GridMatrix(GridShape shape);
  const GridShape& shape() const { return shape_; }

  /// Adds to the block that belongs to `point` itself, and to the block (a, b) with its transpose (b, a); a and b differ.
  void addDiagonal(std::size_t point, const Symmetric3& block, double weight);
  void addCoupling(std::size_t a, std::size_t b, const Matrix3& block, double weight);
  /// Inverts the blocks on the diagonal. To be called once all is added.
  void finish();

  /// y = A x. The bits do not depend on the number of threads.
  void multiply(const SingleVectors& x, SingleVectors& y) const;
  /// y = D^-1 x with D the blocks on the diagonal.
  void multiplyInverseDiagonal(const SingleVectors& x, SingleVectors& y) const;

  /// Calls diagonal(point, block) and coupling(a, b, block) for all of them.
  template <class D, class C>
  void forEach(D&& diagonal, C&& coupling) const;

 private:
  // All blocks that join (layer, r, c) with (otherLayer, r + rows, c + columns): 9 numbers a point.
  struct Offset {
    int layer, otherLayer, rows, columns;
    std::vector<float> blocks;
  };
  // Of a point's blocks: entry e of the block at (row, column) of an offset, or of a layer's diagonal.
  std::size_t place(int row, int column, int entries) const { return (std::size_t(row) * entries) * shape_.columns + column; }
  Offset& offset(int layer, int otherLayer, int rows, int columns);
  /// Makes room for offsets up to so many rows and columns.
  void widen(int reach);
  std::size_t indexOf(int layer, int otherLayer, int rows, int columns) const {
    return ((std::size_t(layer) * shape_.layers + otherLayer) * (reach_ + 1) + rows) * (2 * reach_ + 1) + columns + reach_;
  }

  GridShape shape_;
  std::vector<Offset> offsets_;
  int reach_ = 0;                              // of the offsets that index_ has room for
  std::vector<int> index_;                     // of an offset in offsets_, -1 if there is none
  std::vector<std::vector<float>> diagonal_, inverse_;   // one a layer: 6 numbers a point
};

template <class D, class C>
void GridMatrix::forEach(D&& diagonal, C&& coupling) const {
  const std::size_t stride = std::size_t(shape_.columns);
  for (int l = 0; l < shape_.layers; ++l)
    for (int r = 0; r < shape_.rows; ++r)
      for (int c = 0; c < shape_.columns; ++c) {
        const float* d = &diagonal_[std::size_t(l)][place(r, c, 6)];
        diagonal(shape_.number(l, r, c), Symmetric3{double(d[0]), double(d[stride]), double(d[2 * stride]), double(d[3 * stride]),
                                                    double(d[4 * stride]), double(d[5 * stride])});
      }
  for (const Offset& o : offsets_)
    for (int r = 0; r + o.rows < shape_.rows; ++r)
      for (int c = std::max(0, -o.columns); c < std::min(shape_.columns, shape_.columns - o.columns); ++c) {
        Matrix3 block;
        for (int e = 0; e < 9; ++e) block.m[e / 3][e % 3] = double(o.blocks[place(r, c, 9) + std::size_t(e) * stride]);
        coupling(shape_.number(o.layer, r, c), shape_.number(o.otherLayer, r + o.rows, c + o.columns), block);
      }
}

}  // namespace pectora
