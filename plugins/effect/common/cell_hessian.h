// The second derivative of the cells' energy as blocks between neighbouring nodes.
#pragma once

#include "plugins/effect/common/cell_curvatures.h"
#include "plugins/effect/common/cell_grid.h"

#include "kernel/physics/hessian.h"

#include <memory>

namespace pectora::cells {

/// For every node its own block and those to the 13 neighbours that come after it; in single precision, which only steers
/// a solver.
class CellHessian final : public Hessian {
 public:
  /// `rest` must outlive it.
  explicit CellHessian(const RestCells& rest);
  void linearise(const NodeVectors& positions, bool projected) override;
  void multiply(const NodeVectors& v, NodeVectors& y) const override;
  void addDiagonal(std::vector<Symmetric3>& blocks) const override;
  void forEachCoupling(const Coupling& visit) const override;
  /// Adds for each node the norms of all its blocks: Gershgorin's bound of the eigenvalues.
  void addRowNorms(std::vector<double>& bound) const;

 private:
  // Numbers of the nodes of a row, entry by entry.
  float* row(int l, int r) const { return &values_[(std::size_t(l) * grid_.rows() + r) * kEntries * grid_.columns()]; }
  template <class F>
  void forEachNeighbour(int l, int r, F&& f) const;

  const RestCells& rest_;
  const Grid& grid_;
  std::unique_ptr<float[]> values_;
};

}  // namespace pectora::cells
