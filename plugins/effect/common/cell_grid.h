// The cells of a system in packs, and the order in which they are worked on.
#pragma once

#include "plugins/effect/common/cell_pack.h"
#include "kernel/physics/system.h"
#include "kernel/physics/workers.h"

#include <algorithm>

namespace pectora::cells {

class Grid {
 public:
  explicit Grid(const System& system) : rows_(system.rows), columns_(system.columns), layers_(system.layers) {}

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  int layers() const { return layers_; }
  int blocks() const { return (rows_ + kBlockRows - 1) / kBlockRows; }
  int packsOfRow() const { return (columns_ - 1 + kLanes - 1) / kLanes; }
  std::size_t packs() const { return std::size_t(layers_ - 1) * (rows_ - 1) * packsOfRow(); }
  std::size_t node(int l, int r, int c) const { return (std::size_t(l) * rows_ + r) * columns_ + c; }

  /// A pack: the cells between layers l and l + 1 and rows r and r + 1 from column c on.
  struct Place {
    int l, r, c, count;
    std::size_t index;
  };
  /// Calls f(block, first row, end row) for every block of rows, at most one of two neighbours at a time: so what touches
  /// only the block's rows and the ones beside it is written by one thread at a time, and in one order.
  template <class F>
  void forEachBlock(F&& f) const {
    for (int parity = 0; parity < 2; ++parity)
      parallelFor(std::size_t(blocks() + 1 - parity) / 2, [&](std::size_t i) {
        const int block = 2 * int(i) + parity;
        f(block, block * kBlockRows, std::min(rows_, (block + 1) * kBlockRows));
      });
  }
  /// Calls f(Place) for the packs of a block's rows.
  template <class F>
  void forEachPack(int begin, int end, F&& f) const {
    for (int l = 0; l + 1 < layers_; ++l)
      for (int r = begin; r < std::min(end, rows_ - 1); ++r)
        for (int p = 0; p < packsOfRow(); ++p)
          f(Place{l, r, p * kLanes, std::min(kLanes, columns_ - 1 - p * kLanes), (std::size_t(l) * (rows_ - 1) + r) * packsOfRow() + p});
  }
  CornerRows corners(const NodeVectors& v, const Place& p) const {
    CornerRows corners;
    for (int k = 0; k < 4; ++k) {
      const std::size_t first = node(p.l + (k >> 1), p.r + (k & 1), p.c);
      corners.rows[0][k] = &v.x[first], corners.rows[1][k] = &v.y[first], corners.rows[2][k] = &v.z[first];
    }
    return corners;
  }

 private:
  static constexpr int kBlockRows = 4;
  int rows_, columns_, layers_;
};

/// Cells at rest.
struct RestCells {
  Grid grid;
  NodeVectors positions;
  std::vector<RestPack> packs;   ///< by Grid::Place::index

  Run run(const NodeVectors& x, const Grid::Place& p) const { return {p.count, grid.corners(x, p), grid.corners(positions, p)}; }
};

}  // namespace pectora::cells
