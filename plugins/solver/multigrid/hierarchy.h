// Geometric multigrid over the rows and columns of a grid of layers: each coarser grid has every second row and column, values
// between are interpolated linearly, and its matrix is P^T A P (Galerkin).
#pragma once

#include "plugins/solver/multigrid/grid_matrix.h"

#include <memory>

namespace pectora {

class Hierarchy {
 public:
  explicit Hierarchy(GridShape fine);
  ~Hierarchy();
  Hierarchy& operator=(Hierarchy&&) noexcept;

  /// Product of the fine matrix with a vector.
  using Product = std::function<void(const SingleVectors& x, SingleVectors& y)>;

  /// Takes the coarse matrices from a Hessian at its place; couplings with nodes beyond the grid are left out.
  /// `nodes`: of the whole system.
  void build(const Hessian& hessian, std::size_t nodes, const Product& multiply);
  bool isBuilt() const { return coarsest_ != nullptr; }
  /// x = M^-1 b by one cycle: additive on the finest levels, a V below. M is symmetric and positive definite.
  void cycle(const SingleVectors& b, SingleVectors& x);

 private:
  struct Level;
  struct Coarsest;
  void cycle(std::size_t level, const SingleVectors& b, SingleVectors& x);

  GridShape fine_;
  std::vector<std::unique_ptr<Level>> levels_;   // the first is the fine grid, of which only the diagonal is kept
  std::unique_ptr<Coarsest> coarsest_;
};

}  // namespace pectora
