// The second derivative of the volume effect's energy, and the rows of cells that it shares with the term.
#pragma once

#include "plugins/effect/common/cell_grid.h"
#include "plugins/effect/common/volume_rows.h"

#include "kernel/physics/hessian.h"

namespace pectora::cells {

/// The cells between two layers and two rows of the grid.
struct CellRowPlace {
  std::size_t nodes[4];   // the first ones of the rows at their corners
  std::size_t cell;       // the first one
};

/// The cells of a system, row by row.
class CellRows {
 public:
  explicit CellRows(const System& system) : grid_(system) {}
  const Grid& grid() const { return grid_; }
  /// Cells of a row, and of all rows.
  std::size_t count() const { return std::size_t(grid_.columns() - 1); }
  std::size_t cells() const { return std::size_t(grid_.layers() - 1) * std::size_t(grid_.rows() - 1) * count(); }
  /// Calls f(CellRowPlace) for the rows of cells that begin in rows [begin, end) of the grid.
  template <class F>
  void forEachRow(int begin, int end, F&& f) const {
    for (int l = 0; l + 1 < grid_.layers(); ++l)
      for (int r = begin; r < std::min(end, grid_.rows() - 1); ++r)
        f(CellRowPlace{{grid_.node(l, r, 0), grid_.node(l, r + 1, 0), grid_.node(l + 1, r, 0), grid_.node(l + 1, r + 1, 0)},
                       (std::size_t(l) * std::size_t(grid_.rows() - 1) + std::size_t(r)) * count()});
  }
  template <class Vectors>
  static auto corners(const Vectors& v, const CellRowPlace& p) {
    return CornerRow<typename decltype(v.x)::value_type>{{rowOf(v, p.nodes[0]), rowOf(v, p.nodes[1]), rowOf(v, p.nodes[2]), rowOf(v, p.nodes[3])}};
  }
  /// Adds what is on the diagonals of a row of cells to the corners' vectors.
  template <class Vectors>
  void addToCorners(const CellRowPlace& p, CellNumbers<double> numbers, Vectors& v) const {
    const Row<typename decltype(v.x)::value_type> rows[4] = {rowOf(v, p.nodes[0]), rowOf(v, p.nodes[1]), rowOf(v, p.nodes[2]), rowOf(v, p.nodes[3])};
    cells::addToCorners(count(), numbers, rows);
  }

 private:
  Grid grid_;
};

/// The volumes at rest, and k = kappa / V0 of the energy 1/2 k (V - V0)^2.
struct RestVolumes {
  CellRows rows;
  std::vector<double> volume, stiffness;
};

class VolumeHessian final : public Hessian {
 public:
  /// `rest` must outlive it.
  explicit VolumeHessian(const RestVolumes& rest);

  /// Projected: what follows from the change of pressure alone, k g g^T with g the gradient of the volume. The pressure itself turns forces
  /// with the faces that it presses on, which has as many negative eigenvalues as positive ones.
  void linearise(const NodeVectors& positions, bool projected) override;
  void multiply(const NodeVectors& v, NodeVectors& y) const override { multiplyAny(v, y); }
  void multiplySingle(const SingleVectors& v, SingleVectors& y) const override { multiplyAny(v, y); }
  void addDiagonal(std::vector<Symmetric3>& blocks) const override;
  void forEachCoupling(const Coupling& visit) const override;
  void forEachCouplingRun(const CouplingRun& run, const Coupling& visit) const override;
  /// Takes the derivative at a place, and adds to each node the norms of all its blocks: Gershgorin's bound of the eigenvalues.
  void addBound(const NodeVectors& positions, std::vector<double>& bound);

 private:
  class CornerGradients;
  class Pairs;
  CellNumbers<const float> gradientsOf(const CellRowPlace& p) const { return {&gradients_[kOnDiagonals * p.cell], rest_.rows.count()}; }
  template <class Vectors>
  void multiplyAny(const Vectors& v, Vectors& y) const;

  const RestVolumes& rest_;
  bool projected_ = true;
  std::vector<float> gradients_;              // of the volumes by their diagonals, times the root of k; row by row of cells
  std::vector<float> diagonals_, pressure_;   // unless projected
};

}  // namespace pectora::cells
