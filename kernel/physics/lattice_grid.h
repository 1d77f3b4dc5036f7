// The springs that repeat over the grid of skin and pleura: which there are and in what order, and the wall at rest. Blocks of rows write
// into their neighbours' edges, so first every second block is done and then the others between them: no two at work at one time
// touch the same row, and every sum has one order.
#pragma once

#include "kernel/physics/springs.h"
#include "kernel/physics/workers.h"

#include <algorithm>
#include <cstdlib>

namespace pectora::lattice {

/// The stencil over its grid.
class Grid {
 public:
  Grid(const System& system, std::vector<StencilSpring> stencil)
      : rows_(system.rows), columns_(system.columns), layers_(system.layers), stencil_(std::move(stencil)) {
    for (const StencilSpring& s : stencil_) reach_ = std::max(reach_, std::abs(s.rows));
    blockRows_ = std::max(blockRows_, 2 * reach_ + 2);   // two rows lie between what blocks at work at one time reach
    blocks_ = (std::size_t(rows_) + blockRows_ - 1) / blockRows_;
  }

  const std::vector<StencilSpring>& stencil() const { return stencil_; }
  std::size_t columns() const { return std::size_t(columns_); }
  /// Nodes of all layers.
  std::size_t nodes() const { return std::size_t(layers_) * rows_ * columns_; }
  std::size_t blocks() const { return blocks_; }

  std::size_t node(Layer layer, int row, int column) const { return (std::size_t(layer == Layer::inner ? layers_ - 1 : 0) * rows_ + row) * columns_ + column; }

  /// The springs of stencil entry `entry` that start in `row`.
  struct Run {
    std::size_t near, far, count, column;   // first nodes, how many, first column
  };
  Run run(int row, std::size_t entry) const {
    const StencilSpring& s = stencil_[entry];
    const int other = row + s.rows;
    const auto [first, end] = startsOf(s);
    if (other < 0 || other >= rows_ || first >= end) return {0, 0, 0, 0};
    return {node(s.from, row, first), node(s.to, other, first + s.columns), std::size_t(end - first), std::size_t(first)};
  }

  struct Range {
    int first, end;
  };
  /// The columns in which springs of a stencil entry start; empty if none does.
  Range startsOf(const StencilSpring& s) const { return {std::max(0, -s.columns), std::min(columns_, columns_ - s.columns)}; }
  /// The rows that springs which start in rows [begin, end) reach.
  Range reached(int begin, int end) const { return {std::max(0, begin - reach_), std::min(rows_, end + reach_)}; }

  /// Calls f(block, first row, end row) for every block, at most one of two neighbours at a time.
  template <class F>
  void forEachBlock(F&& f) const {
    for (std::size_t parity = 0; parity < 2; ++parity)
      parallelFor((blocks_ + 1 - parity) / 2, [&](std::size_t i) {
        const std::size_t block = 2 * i + parity;
        f(block, int(block) * blockRows_, std::min(rows_, int(block + 1) * blockRows_));
      });
  }

  /// Calls f(run, stencil entry) for all rows, or those of a block.
  template <class F>
  void forEachRun(F&& f) const { forEachRun(0, rows_, f); }
  template <class F>
  void forEachRun(int begin, int end, F&& f) const {
    for (int row = begin; row < end; ++row)
      for (std::size_t entry = 0; entry < stencil_.size(); ++entry)
        if (const Run r = run(row, entry); r.count > 0) f(r, entry);
  }

 private:
  int rows_, columns_, layers_, reach_ = 0, blockRows_ = 8;
  std::size_t blocks_;
  std::vector<StencilSpring> stencil_;
};

/// The nodes of all layers counted from `origin`, which keeps them small.
inline void take(const NodeVectors& from, Vec3 origin, SingleVectors& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to.x[i] = float(from.x[i] - origin.x);
  for (std::size_t i = 0; i < to.size(); ++i) to.y[i] = float(from.y[i] - origin.y);
  for (std::size_t i = 0; i < to.size(); ++i) to.z[i] = float(from.z[i] - origin.z);
}

/// The wall at rest.
struct RestLattice {
  Grid grid;
  NodeVectors nodes;      ///< of all layers
  SingleVectors single;   ///< the same, counted from the first

  RestLattice(const System& system, std::vector<StencilSpring> stencil) : grid(system, std::move(stencil)), nodes(grid.nodes()), single(grid.nodes()) {
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes.set(i, system.rest[i]);
    take(nodes, nodes[0], single);
  }
};

}  // namespace pectora::lattice
