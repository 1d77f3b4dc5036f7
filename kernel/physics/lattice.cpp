// The springs that repeat over the grid of skin and pleura. Each is evaluated once, by the row in which it starts. Blocks of
// rows write into their neighbours' edges, so first every second block is done and then the others between them: no two at
// work at one time touch the same row, and every sum has one order.
#include "kernel/physics/hessian.h"
#include "kernel/physics/lattice_rows.h"
#include "kernel/physics/springs.h"
#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

using namespace lattice;

// The stencil over its grid: which springs there are, and in what order.
class Grid {
 public:
  Grid(const System& system, std::vector<StencilSpring> stencil)
      : rows_(system.rows), columns_(system.columns), layers_(system.layers), stencil_(std::move(stencil)) {
    for (const StencilSpring& s : stencil_) blockRows_ = std::max(blockRows_, 2 * std::abs(s.rows));
    blocks_ = (std::size_t(rows_) + blockRows_ - 1) / blockRows_;
  }

  const std::vector<StencilSpring>& stencil() const { return stencil_; }
  std::size_t columns() const { return std::size_t(columns_); }
  std::size_t blocks() const { return blocks_; }
  /// Entries of an array with one place a spring; those of springs that reach over the edge are not used.
  std::size_t slots() const { return std::size_t(rows_) * stencil_.size() * columns(); }

  /// The springs of stencil entry `entry` that start in `row`.
  struct Run {
    std::size_t near, far, count, slot, column;   // first nodes, how many, place in arrays of slots, first column
  };
  Run run(int row, std::size_t entry) const {
    const StencilSpring& s = stencil_[entry];
    const int other = row + s.rows, first = std::max(0, -s.columns), end = std::min(columns_, columns_ - s.columns);
    if (other < 0 || other >= rows_ || first >= end) return {0, 0, 0, 0, 0};
    const auto node = [&](Layer layer, int r, int c) { return (std::size_t(layer == Layer::inner ? layers_ - 1 : 0) * rows_ + r) * columns_ + c; };
    return {node(s.from, row, first), node(s.to, other, first + s.columns), std::size_t(end - first),
            (std::size_t(row) * stencil_.size() + entry) * columns_ + first, std::size_t(first)};
  }

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
  int rows_, columns_, layers_, blockRows_ = 8;
  std::size_t blocks_;
  std::vector<StencilSpring> stencil_;
};

ConstRow rowOf(const NodeVectors& v, std::size_t node) { return {&v.x[node], &v.y[node], &v.z[node]}; }
Row rowOf(NodeVectors& v, std::size_t node) { return {&v.x[node], &v.y[node], &v.z[node]}; }

// What a spring of no length does: it pushes along the direction that it had at rest.
struct Degenerate {
  std::size_t near, far, slot;
  Vec3 direction;
  double stiffness, restLength, length;
};

class LatticeTerm;

class LatticeHessian final : public Hessian {
 public:
  explicit LatticeHessian(const LatticeTerm& term);
  void linearise(const NodeVectors& positions, bool projected) override;
  void multiply(const NodeVectors& v, NodeVectors& y) const override;
  void addDiagonal(std::vector<Symmetric3>& blocks) const override;

 private:
  // The four rows of numbers of a run lie beside each other.
  RowCurvature curvature(std::size_t slot) const;
  const LatticeTerm& term_;
  std::unique_ptr<float[]> values_;
};

class LatticeTerm final : public Term {
 public:
  LatticeTerm(std::string name, const System& system, std::vector<StencilSpring> stencil)
      : name_(std::move(name)), grid_(system, std::move(stencil)), rest_(system.rest), restLength_(grid_.slots()) {
    grid_.forEachRun([&](const Grid::Run& r, std::size_t) {
      for (std::size_t i = 0; i < r.count; ++i) restLength_[r.slot + i] = distance(rest_[r.near + i], rest_[r.far + i]);
    });
  }

  std::string name() const override { return name_; }
  const Grid& grid() const { return grid_; }
  RowSprings springs(const NodeVectors& positions, const Grid::Run& r, std::size_t entry) const {
    const StencilSpring& s = grid_.stencil()[entry];
    return {r.count, rowOf(positions, r.near), rowOf(positions, r.far), &restLength_[r.slot], s.stiffnessNPerMm, s.compression};
  }

  double energy(const NodeVectors& positions) const override {
    std::vector<double> energies(grid_.blocks());
    grid_.forEachBlock([&](std::size_t block, int begin, int end) {
      std::vector<double> twice(grid_.columns());
      grid_.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t entry) {
        springEnergies(springs(positions, r, entry), &twice[r.column]);
      });
      for (const double e : twice) energies[block] += 0.5 * e;
    });
    double total = 0;
    for (const double e : energies) total += e;
    return total;
  }

  double evaluate(const NodeVectors& positions, NodeVectors& gradient, double& largestForce) const override {
    const std::size_t columns = grid_.columns();
    std::vector<double> energies(grid_.blocks()), largest(grid_.blocks());
    grid_.forEachBlock([&](std::size_t block, int begin, int end) {
      std::vector<double> work(6 * columns);
      const Row pull{&work[0], &work[columns], &work[2 * columns]};
      double *twice = &work[3 * columns], *greatest = &work[4 * columns], *degenerate = &work[5 * columns];
      grid_.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t entry) {
        springForces(springs(positions, r, entry), pull, {twice + r.column, greatest + r.column, degenerate + r.column});
        const ConstRow pulled{pull.x, pull.y, pull.z};
        addRow(r.count, pulled, -1, rowOf(gradient, r.near));
        addRow(r.count, pulled, 1, rowOf(gradient, r.far));
      });
      for (std::size_t c = 0; c < columns; ++c) {
        energies[block] += 0.5 * twice[c];
        largest[block] = std::max(largest[block], greatest[c]);
      }
      if (std::any_of(degenerate, degenerate + columns, [](double d) { return d > 0; }))
        forEachDegenerate(positions, begin, end, [&](const Degenerate& d) {
          const Vec3 force = d.direction * (d.stiffness * (d.length - d.restLength));
          gradient.add(d.near, -force);
          gradient.add(d.far, force);
        });
    });
    double total = 0;
    for (std::size_t block = 0; block < grid_.blocks(); ++block) {
      total += energies[block];
      largestForce = std::max(largestForce, largest[block]);
    }
    return total;
  }

  void addStiffnessBound(std::vector<double>& bound) const override {
    grid_.forEachRun([&](const Grid::Run& r, std::size_t entry) {
      for (std::size_t i = 0; i < r.count; ++i) {
        bound[r.near + i] += 2 * grid_.stencil()[entry].stiffnessNPerMm;
        bound[r.far + i] += 2 * grid_.stencil()[entry].stiffnessNPerMm;
      }
    });
  }

  bool hasHessian() const override { return true; }
  std::unique_ptr<Hessian> makeHessian() const override { return std::make_unique<LatticeHessian>(*this); }
  bool hasSprings() const override { return true; }
  void forEachSpring(const std::function<void(const Spring&)>& visit) const override {
    grid_.forEachRun([&](const Grid::Run& r, std::size_t entry) {
      const StencilSpring& s = grid_.stencil()[entry];
      for (std::size_t i = 0; i < r.count; ++i)
        visit({r.near + i, r.far + i, s.stiffnessNPerMm, restLength_[r.slot + i], s.compression});
    });
  }

  // Calls f(Degenerate) for every spring of a block that has no direction of its own.
  template <class F>
  void forEachDegenerate(const NodeVectors& positions, int begin, int end, F&& f) const {
    grid_.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t entry) {
      const StencilSpring& s = grid_.stencil()[entry];
      for (std::size_t i = 0; i < r.count; ++i) {
        const double length = distance(positions[r.near + i], positions[r.far + i]), restLength = restLength_[r.slot + i];
        if (length > kDegenerate * restLength) continue;
        const double stiffness = s.stiffnessNPerMm * (length < restLength ? s.compression : 1);
        f({r.near + i, r.far + i, r.slot + i, normalized(rest_[r.far + i] - rest_[r.near + i]), stiffness, restLength, length});
      }
    });
  }

 private:
  std::string name_;
  Grid grid_;
  NodeVectors rest_;
  std::vector<double> restLength_;
};

LatticeHessian::LatticeHessian(const LatticeTerm& term)
    : term_(term), values_(std::make_unique_for_overwrite<float[]>(4 * term.grid().slots())) {}

RowCurvature LatticeHessian::curvature(std::size_t slot) const {
  const std::size_t columns = term_.grid().columns(), column = slot % columns;
  float* first = &values_[4 * (slot - column) + column];
  return {first, first + columns, first + 2 * columns, first + 3 * columns};
}

void LatticeHessian::linearise(const NodeVectors& positions, bool projected) {
  const Grid& grid = term_.grid();
  grid.forEachBlock([&](std::size_t, int begin, int end) {
    std::vector<double> degenerate(grid.columns());
    grid.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t entry) {
      springCurvatures(term_.springs(positions, r, entry), projected, curvature(r.slot), &degenerate[r.column]);
    });
    if (std::none_of(degenerate.begin(), degenerate.end(), [](double d) { return d > 0; })) return;
    term_.forEachDegenerate(positions, begin, end, [&](const Degenerate& d) {
      const RowCurvature c = curvature(d.slot);
      const Vec3 m = d.direction * std::sqrt(d.stiffness);
      *c.mx = float(m.x), *c.my = float(m.y), *c.mz = float(m.z);
      *c.a = d.restLength > 0 ? 0 : float(d.stiffness);   // a spring that has no length at rest is as stiff in any direction
    });
  });
}

void LatticeHessian::multiply(const NodeVectors& v, NodeVectors& y) const {
  const Grid& grid = term_.grid();
  const std::size_t columns = grid.columns();
  grid.forEachBlock([&](std::size_t, int begin, int end) {
    std::vector<double> work(3 * columns);
    const Row pull{&work[0], &work[columns], &work[2 * columns]};
    grid.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t) {
      curvatureProducts(r.count, rowOf(v, r.near), rowOf(v, r.far), curvature(r.slot), pull);
      const ConstRow pulled{pull.x, pull.y, pull.z};
      addRow(r.count, pulled, -1, rowOf(y, r.near));
      addRow(r.count, pulled, 1, rowOf(y, r.far));
    });
  });
}

void LatticeHessian::addDiagonal(std::vector<Symmetric3>& blocks) const {
  const Grid& grid = term_.grid();
  grid.forEachBlock([&](std::size_t, int begin, int end) {
    grid.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t) {
      const RowCurvature c = curvature(r.slot);
      for (std::size_t i = 0; i < r.count; ++i) {
        const double x = double(c.mx[i]), y = double(c.my[i]), z = double(c.mz[i]), a = double(c.a[i]);
        const Symmetric3 block{a + x * x, x * y, x * z, a + y * y, y * z, a + z * z};
        blocks[r.near + i] += block;
        blocks[r.far + i] += block;
      }
    });
  });
}

}  // namespace

std::unique_ptr<Term> makeLatticeTerm(std::string name, const System& system, std::vector<StencilSpring> stencil) {
  return std::make_unique<LatticeTerm>(std::move(name), system, std::move(stencil));
}

}  // namespace pectora
