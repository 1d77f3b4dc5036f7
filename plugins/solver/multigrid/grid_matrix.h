// A symmetric matrix of 3 x 3 blocks over the points of a grid of layers, in which a point is joined with its near neighbours
// only. Single precision: it only steers a solver.
#pragma once

#include "plugins/solver/multigrid/block_rows.h"

#include "kernel/physics/hessian.h"
#include "kernel/physics/workers.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

namespace pectora {

struct GridPoint {
  int layer = 0, row = 0, column = 0;
};

/// Layers of rows x columns points. Point (l, r, c) has the number (l * rows + r) * columns + c.
struct GridShape {
  int layers = 0, rows = 0, columns = 0;
  bool operator==(const GridShape&) const = default;
  std::size_t points() const { return std::size_t(layers) * rows * columns; }
  std::size_t number(int layer, int row, int column) const { return (std::size_t(layer) * rows + row) * columns + column; }
  GridPoint point(std::size_t number) const {
    const int line = int(number / columns);
    return {line / rows, line % rows, int(number % columns)};
  }
};

/// Calls f(line) for all rows of all layers, on several threads where a grid has points enough.
template <class F>
void forEachLine(GridShape shape, F&& f) {
  constexpr std::size_t kPoints = 2048;   // that are worth a thread
  const std::size_t length = 1 + kPoints / std::size_t(shape.columns);
  forEachPiece(std::size_t(shape.layers) * shape.rows, length, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t line = begin; line < end; ++line) f(line);
  });
}

class GridMatrix {
 public:
  explicit GridMatrix(GridShape shape);
  const GridShape& shape() const { return shape_; }

  /// Adds to the blocks (a, b), and their transposes to (b, a), for `count` neighbours along the row from a and b on: entry (j, k) of block i
  /// is weight * entries[3 j + k][i]. Where a is b, the block gets both itself. Several threads may add at once in rows that none of
  /// them shares.
  void add(GridPoint a, GridPoint b, std::size_t count, const float* const entries[9], float weight);
  /// Adds to the blocks of all points themselves; what comes after the last point is left out.
  void addDiagonal(const std::vector<Symmetric3>& blocks);
  /// Inverts the blocks on the diagonal. To be called once all is added.
  void finish();
  /// Forgets all that multiplyInverseDiagonal does without.
  void keepInverseDiagonal();

  /// y = A x. The bits do not depend on the number of threads.
  void multiply(const SingleVectors& x, SingleVectors& y) const;
  /// y = D^-1 x with D the blocks on the diagonal.
  void multiplyInverseDiagonal(const SingleVectors& x, SingleVectors& y) const;

  /// Calls run(a, b, count, entries) for all blocks, as add takes them; those with a = b in full. Runs of rows that lie apart as
  /// Hessian::forEachCouplingRun says may come from several threads at once.
  using Run = std::function<void(GridPoint a, GridPoint b, std::size_t count, const float* const entries[9])>;
  void forEachRun(const Run& run) const;

 private:
  // All blocks that join (layer, r, c) with (otherLayer, r + rows, c + columns): 9 numbers a point.
  struct Offset {
    int layer, otherLayer, rows, columns;
    std::vector<float> blocks;
  };
  // Of a point's blocks: entry 0 of the block at (row, column) of an offset, or of a layer's diagonal.
  std::size_t place(int row, int column, int entries) const { return (std::size_t(row) * entries) * shape_.columns + column; }
  Offset& offset(int layer, int otherLayer, int rows, int columns);
  /// Calls f(first row, end row) for blocks of rows, at most one of two neighbours at a time; none reaches beyond the next.
  template <class F>
  void forEachRowBlock(F&& f) const;
  /// Calls f(columns' first, end) of the points whose far end is in the grid, if there are any.
  template <class F>
  void inGrid(const Offset& offset, F&& f) const;

  GridShape shape_;
  std::mutex adding_;                                    // guards the list of offsets
  std::vector<std::unique_ptr<Offset>> offsets_;
  std::vector<std::vector<float>> diagonal_, inverse_;   // one a layer: 6 numbers a point
  static constexpr int kNear = 4;
  std::vector<std::atomic<Offset*>> near_;               // offsets of at most so many rows and columns, null until there is one
};

}  // namespace pectora
