// The second derivative of the lattice's energy, in single precision: it only steers a solver.
#pragma once

#include "kernel/physics/hessian.h"
#include "kernel/physics/lattice_grid.h"
#include "kernel/physics/lattice_rows.h"

namespace pectora::lattice {

class LatticeHessian final : public Hessian {
 public:
  /// `rest` must outlive it.
  explicit LatticeHessian(const RestLattice& rest);
  void linearise(const NodeVectors& positions, bool projected) override;
  void multiply(const NodeVectors& v, NodeVectors& y) const override;
  void multiplySingle(const SingleVectors& v, SingleVectors& y) const override;
  void addDiagonal(std::vector<Symmetric3>& blocks) const override;
  void forEachCoupling(const Coupling& visit) const override;
  void forEachCouplingRun(const CouplingRun& run, const Coupling& visit) const override;

 private:
  RowSprings<float> springs(const Grid::Run& run, std::size_t entry) const;
  // The blocks of a run's springs that join their ends.
  class Blocks {
   public:
    explicit Blocks(std::size_t columns) : room_(6 * columns) {
      for (std::size_t e = 0; e < 6; ++e) entries[e] = &room_[e * columns];
    }
    Symmetric3 operator[](std::size_t i) const {
      const auto at = [&](int e) { return double(entries[e][i]); };
      return {at(0), at(1), at(2), at(3), at(4), at(5)};
    }
    void set(std::size_t i, const Symmetric3& b) {
      const double values[6] = {b.xx, b.xy, b.xz, b.yy, b.yz, b.zz};
      for (int e = 0; e < 6; ++e) entries[e][i] = float(values[e]);
    }
    float* entries[6];   // xx xy xz yy yz zz

   private:
    std::vector<float> room_;
  };
  void fill(const Grid::Run& run, std::size_t entry, Blocks& blocks) const;
  // The second derivative of a spring that has no direction of its own.
  Symmetric3 degenerateBlock(const Grid::Run& run, std::size_t entry, std::size_t i) const;
  bool isDegenerate(const Grid::Run& run, std::size_t i) const;

  const RestLattice& rest_;
  SingleVectors moved_;
  bool projected_ = true;
};

}  // namespace pectora::lattice
