// The springs that repeat over the grid of skin and pleura. Each is evaluated once, by the row in which it starts. Blocks of
// rows write into their neighbours' edges, so first every second block is done and then the others between them: no two at
// work at one time touch the same row, and every sum has one order.
#include "kernel/physics/hessian.h"
#include "kernel/physics/lattice_rows.h"
#include "kernel/physics/springs.h"
#include "kernel/physics/stencil_row.h"
#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace pectora {
namespace {

using namespace lattice;

// The stencil over its grid: which springs there are, and in what order.
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
    const int other = row + s.rows, first = std::max(0, -s.columns), end = std::min(columns_, columns_ - s.columns);
    if (other < 0 || other >= rows_ || first >= end) return {0, 0, 0, 0};
    return {node(s.from, row, first), node(s.to, other, first + s.columns), std::size_t(end - first), std::size_t(first)};
  }

  /// The rows that springs which start in rows [begin, end) reach.
  struct Rows {
    int first, end;
  };
  Rows reached(int begin, int end) const { return {std::max(0, begin - reach_), std::min(rows_, end + reach_)}; }

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

// The nodes of the grid, counted from `origin`, which keeps them small.
void take(const NodeVectors& from, Vec3 origin, SingleVectors& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to.x[i] = float(from.x[i] - origin.x);
  for (std::size_t i = 0; i < to.size(); ++i) to.y[i] = float(from.y[i] - origin.y);
  for (std::size_t i = 0; i < to.size(); ++i) to.z[i] = float(from.z[i] - origin.z);
}

// What a spring of no length does: it pushes along the direction that it had at rest.
struct Degenerate {
  std::size_t near, far;
  Vec3 direction;
  double stiffness, restLength, length;
};

class LatticeTerm;

class LatticeHessian final : public Hessian {
 public:
  explicit LatticeHessian(const LatticeTerm& term);
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

  const LatticeTerm& term_;
  const SingleVectors& rest_;
  SingleVectors moved_;
  bool projected_ = true;
};

class LatticeTerm final : public Term {
 public:
  LatticeTerm(std::string name, const System& system, std::vector<StencilSpring> stencil)
      : name_(std::move(name)), grid_(system, std::move(stencil)), rest_(grid_.nodes()), restSingle_(grid_.nodes()), aside_(grid_.stencil()) {
    for (std::size_t i = 0; i < rest_.size(); ++i) rest_.set(i, system.rest[i]);
    take(rest_, rest_[0], restSingle_);
    std::stable_sort(aside_.begin(), aside_.end(), [](const StencilSpring& a, const StencilSpring& b) { return a.columns < b.columns; });
    for (const StencilSpring& s : aside_)
      while (beyond_ < std::size_t(std::abs(s.columns))) beyond_ += kChunk;
  }

  std::string name() const override { return name_; }
  const Grid& grid() const { return grid_; }
  /// The nodes of all layers at rest, and the same counted from the first, which keeps them small.
  const NodeVectors& rest() const { return rest_; }
  const SingleVectors& restSingle() const { return restSingle_; }
  RowSprings<double> springs(const NodeVectors& positions, const Grid::Run& r, std::size_t entry) const {
    const StencilSpring& s = grid_.stencil()[entry];
    return {r.count, rowOf(positions, r.near), rowOf(positions, r.far), rowOf(rest_, r.near), rowOf(rest_, r.far),
            s.stiffnessNPerMm, s.compression};
  }
  double restLength(const Grid::Run& r, std::size_t i) const { return distance(rest_[r.near + i], rest_[r.far + i]); }

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
    return evaluate(largestForce, [&](int begin, int end, BlockSums& sums) { evaluateBlock(positions, begin, end, gradient, sums); });
  }
  double evaluateRoughly(const NodeVectors& positions, NodeVectors& gradient, double& largestForce) const override {
    return evaluate(largestForce, [&](int begin, int end, BlockSums& sums) {
      if (!evaluateBlockRoughly(positions, begin, end, gradient, sums)) evaluateBlock(positions, begin, end, gradient, sums);
    });
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
        visit({r.near + i, r.far + i, s.stiffnessNPerMm, restLength(r, i), s.compression});
    });
  }

  // Calls f(Degenerate) for every spring of a block that has no direction of its own.
  template <class F>
  void forEachDegenerate(const NodeVectors& positions, int begin, int end, F&& f) const {
    grid_.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t entry) {
      const StencilSpring& s = grid_.stencil()[entry];
      for (std::size_t i = 0; i < r.count; ++i) {
        const double length = distance(positions[r.near + i], positions[r.far + i]), rest = restLength(r, i);
        if (length > kDegenerate * rest) continue;
        const double stiffness = s.stiffnessNPerMm * (length < rest ? s.compression : 1);
        f({r.near + i, r.far + i, normalized(rest_[r.far + i] - rest_[r.near + i]), stiffness, rest, length});
      }
    });
  }

 private:
  // What a block of rows adds up.
  struct BlockSums {
    double energy = 0, largest = 0;
  };
  // Calls one(first row, end row, sums) for every block; returns the energy.
  template <class F>
  double evaluate(double& largestForce, F&& one) const {
    std::vector<BlockSums> sums(grid_.blocks());
    grid_.forEachBlock([&](std::size_t block, int begin, int end) { one(begin, end, sums[block]); });
    double total = 0;
    for (const BlockSums& s : sums) {
      total += s.energy;
      largestForce = std::max(largestForce, s.largest);
    }
    return total;
  }

  void evaluateBlock(const NodeVectors& positions, int begin, int end, NodeVectors& gradient, BlockSums& sums) const {
    const std::size_t columns = grid_.columns();
    std::vector<double> work(6 * columns);
    const Row<double> pull{&work[0], &work[columns], &work[2 * columns]};
    double *twice = &work[3 * columns], *greatest = &work[4 * columns], *degenerate = &work[5 * columns];
    grid_.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t entry) {
      springForces(springs(positions, r, entry), rowOf(gradient, r.near), pull, {twice + r.column, greatest + r.column, degenerate + r.column});
      addRow(r.count, {pull.x, pull.y, pull.z}, rowOf(gradient, r.far));
    });
    for (std::size_t c = 0; c < columns; ++c) {
      sums.energy += 0.5 * twice[c];
      sums.largest = std::max(sums.largest, greatest[c]);
    }
    if (std::any_of(degenerate, degenerate + columns, [](double d) { return d > 0; }))
      forEachDegenerate(positions, begin, end, [&](const Degenerate& d) {
        const Vec3 force = d.direction * (d.stiffness * (d.length - d.restLength));
        gradient.add(d.near, -force);
        gradient.add(d.far, force);
      });
  }

  // Returns false, and has done nothing, where a spring has no direction or a number is not finite.
  bool evaluateBlockRoughly(const NodeVectors& positions, int begin, int end, NodeVectors& gradient, BlockSums& sums) const {
    const std::size_t columns = grid_.columns();
    const Grid::Rows rows = grid_.reached(begin, end);
    thread_local Room room;
    room.setSize(std::size_t(rows.end - rows.first), columns, beyond_);
    forEachRow(rows, [&](Layer layer, int row, std::size_t node) {
      const std::size_t place = room.place(layer, row - rows.first);
      subtractRows(columns, rowOf(positions, node), rowOf(rest_, node), at(room.moved, place));
      const ConstRow<float> rest = rowOf(restSingle_, node);
      std::copy_n(rest.x, columns, room.rest.x + place);
      std::copy_n(rest.y, columns, room.rest.y + place);
      std::copy_n(rest.z, columns, room.rest.z + place);
    });
    bool isDegenerate = false;
    std::vector<RowEntry> entries;
    for (int row = begin; row < end; ++row)
      for (const Layer layer : {Layer::outer, Layer::inner}) {
        entries.clear();
        for (const StencilSpring& s : aside_) {
          const std::ptrdiff_t first = std::max(0, -s.columns), last = std::ptrdiff_t(columns) - std::max(0, s.columns);
          if (s.from != layer || row + s.rows < rows.first || row + s.rows >= rows.end || first >= last) continue;
          const std::ptrdiff_t far = std::ptrdiff_t(room.place(s.to, row + s.rows - rows.first)) - std::ptrdiff_t(room.place(layer, row - rows.first)) + s.columns;
          entries.push_back({far, first, last, float(s.stiffnessNPerMm), float(s.stiffnessNPerMm * s.compression)});
        }
        const std::size_t place = room.place(layer, row - rows.first);
        isDegenerate |= addRowForces({columns, entries.data(), entries.data() + entries.size(), constant(at(room.moved, place)), constant(at(room.rest, place)),
                                      at(room.forces, place), room.twiceEnergy, room.largestSquared});
      }
    for (std::size_t c = 0; c < columns; ++c) {
      sums.energy += 0.5 * double(room.twiceEnergy[c]);
      sums.largest = std::max(sums.largest, std::sqrt(double(room.largestSquared[c])));
    }
    if (isDegenerate || !std::isfinite(sums.energy)) {
      sums = {};
      return false;
    }
    forEachRow(rows, [&](Layer layer, int row, std::size_t node) {
      addRow(columns, constant(at(room.forces, room.place(layer, row - rows.first))), rowOf(gradient, node));
    });
    return true;
  }

  // Calls f(layer, row, its first node) for skin and pleura.
  template <class F>
  void forEachRow(Grid::Rows rows, F&& f) const {
    for (const Layer layer : {Layer::outer, Layer::inner})
      for (int row = rows.first; row < rows.end; ++row) f(layer, row, grid_.node(layer, row, 0));
  }

  // Skin and pleura of some rows in single precision, with what springs reach beyond the columns; and what columns add up.
  struct Room {
    Row<float> moved, rest, forces;
    float *twiceEnergy, *largestSquared;

    void setSize(std::size_t rows, std::size_t columns, std::size_t beyond) {
      const std::size_t whole = (columns + kChunk - 1) / kChunk * kChunk;
      stride_ = whole + beyond;
      layer_ = rows * stride_;
      beyond_ = beyond;
      const std::size_t all = beyond + 2 * layer_ + kSkew;
      numbers_.resize(9 * all + 2 * whole + kChunk);
      // Rows begin where registers do.
      float* next = numbers_.data() + (kChunk - reinterpret_cast<std::uintptr_t>(numbers_.data()) / sizeof(float) % kChunk) % kChunk;
      const auto take = [&](std::size_t count, float value) { return std::fill_n(next, count, value), std::exchange(next, next + count); };
      const auto takeRow = [&](float value) { return Row<float>{take(all, value), take(all, value), take(all, value)}; };
      moved = takeRow(0), rest = takeRow(kBeyond), forces = takeRow(0);
      twiceEnergy = take(whole, 0), largestSquared = take(whole, 0);
    }
    // Of the first column.
    std::size_t place(Layer layer, int row) const { return beyond_ + (layer == Layer::inner ? layer_ : 0) + std::size_t(row) * stride_; }

   private:
    static constexpr std::size_t kSkew = 5 * kChunk;   // so that vectors of a node do not compete for one place in a cache
    std::vector<float> numbers_;
    std::size_t stride_ = 0, layer_ = 0, beyond_ = 0;
  };

  std::string name_;
  Grid grid_;
  NodeVectors rest_;
  SingleVectors restSingle_;
  std::vector<StencilSpring> aside_;   // the stencil, those that end in different rows next to each other
  std::size_t beyond_ = kChunk;        // at least as many columns as springs reach
};

LatticeHessian::LatticeHessian(const LatticeTerm& term)
    : term_(term), rest_(term.restSingle()), moved_(term.grid().nodes()) {}

void LatticeHessian::linearise(const NodeVectors& positions, bool projected) {
  const NodeVectors& rest = term_.rest();
  for (std::size_t i = 0; i < moved_.size(); ++i) moved_.set(i, positions[i] - rest[i]);
  projected_ = projected;
}

RowSprings<float> LatticeHessian::springs(const Grid::Run& r, std::size_t entry) const {
  const StencilSpring& s = term_.grid().stencil()[entry];
  return {r.count, rowOf(moved_, r.near), rowOf(moved_, r.far), rowOf(rest_, r.near), rowOf(rest_, r.far), float(s.stiffnessNPerMm), float(s.compression)};
}

bool LatticeHessian::isDegenerate(const Grid::Run& r, std::size_t i) const {
  // In the same steps as the rows do it.
  const float x0 = rest_.x[r.far + i] - rest_.x[r.near + i], y0 = rest_.y[r.far + i] - rest_.y[r.near + i], z0 = rest_.z[r.far + i] - rest_.z[r.near + i];
  const float x = x0 + (moved_.x[r.far + i] - moved_.x[r.near + i]), y = y0 + (moved_.y[r.far + i] - moved_.y[r.near + i]),
              z = z0 + (moved_.z[r.far + i] - moved_.z[r.near + i]);
  return x * x + y * y + z * z <= kDegenerateSingle * kDegenerateSingle * (x0 * x0 + y0 * y0 + z0 * z0);
}

// It counts as projected: k along the direction at rest, or, if it has no length at rest, in any direction.
Symmetric3 LatticeHessian::degenerateBlock(const Grid::Run& r, std::size_t entry, std::size_t i) const {
  const StencilSpring& s = term_.grid().stencil()[entry];
  const Vec3 d = term_.rest()[r.far + i] - term_.rest()[r.near + i], n = normalized(d);
  Symmetric3 block;
  if (norm(d) > 0) {
    const double k = s.stiffnessNPerMm * s.compression;
    block = {k * n.x * n.x, k * n.x * n.y, k * n.x * n.z, k * n.y * n.y, k * n.y * n.z, k * n.z * n.z};
  } else {
    block.addIdentity(s.stiffnessNPerMm);
  }
  return block;
}

void LatticeHessian::multiply(const NodeVectors& v, NodeVectors& y) const {
  SingleVectors in(term_.grid().nodes()), out(in);
  take(v, {}, in);
  multiplySingle(in, out);
  for (std::size_t i = 0; i < out.size(); ++i) y.x[i] += double(out.x[i]);
  for (std::size_t i = 0; i < out.size(); ++i) y.y[i] += double(out.y[i]);
  for (std::size_t i = 0; i < out.size(); ++i) y.z[i] += double(out.z[i]);
}

void LatticeHessian::multiplySingle(const SingleVectors& v, SingleVectors& y) const {
  const Grid& grid = term_.grid();
  const std::size_t columns = grid.columns();
  grid.forEachBlock([&](std::size_t, int begin, int end) {
    std::vector<float> work(3 * columns);
    const Row<float> pull{&work[0], &work[columns], &work[2 * columns]};
    grid.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t entry) {
      if (curvatureProducts(springs(r, entry), projected_, rowOf(v, r.near), rowOf(v, r.far), rowOf(y, r.near), pull))
        for (std::size_t i = 0; i < r.count; ++i)
          if (isDegenerate(r, i)) {
            const Vec3 p = degenerateBlock(r, entry, i) * (v[r.far + i] - v[r.near + i]);
            pull.x[i] = float(p.x), pull.y[i] = float(p.y), pull.z[i] = float(p.z);
            y.set(r.near + i, y[r.near + i] - p);
          }
      addRow(r.count, constant(pull), rowOf(y, r.far));
    });
  });
}

void LatticeHessian::fill(const Grid::Run& r, std::size_t entry, Blocks& blocks) const {
  if (!springBlocks(springs(r, entry), projected_, blocks.entries)) return;
  for (std::size_t i = 0; i < r.count; ++i)
    if (isDegenerate(r, i)) blocks.set(i, -degenerateBlock(r, entry, i));
}

void LatticeHessian::addDiagonal(std::vector<Symmetric3>& diagonal) const {
  const Grid& grid = term_.grid();
  grid.forEachBlock([&](std::size_t, int begin, int end) {
    Blocks blocks(grid.columns());
    grid.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t entry) {
      fill(r, entry, blocks);
      for (std::size_t i = 0; i < r.count; ++i) {
        const Symmetric3 own = -blocks[i];
        diagonal[r.near + i] += own;
        diagonal[r.far + i] += own;
      }
    });
  });
}

void LatticeHessian::forEachCoupling(const Coupling& visit) const {
  Blocks blocks(term_.grid().columns());
  term_.grid().forEachRun([&](const Grid::Run& r, std::size_t entry) {
    fill(r, entry, blocks);
    for (std::size_t i = 0; i < r.count; ++i) {
      const Symmetric3 b = blocks[i];
      visit(r.near + i, r.far + i, {{{b.xx, b.xy, b.xz}, {b.xy, b.yy, b.yz}, {b.xz, b.yz, b.zz}}});
    }
  });
}

void LatticeHessian::forEachCouplingRun(const CouplingRun& run, const Coupling&) const {
  const Grid& grid = term_.grid();
  grid.forEachBlock([&](std::size_t, int begin, int end) {
    Blocks blocks(grid.columns());
    float* const* e = blocks.entries;
    const float* const entries[9] = {e[0], e[1], e[2], e[1], e[3], e[4], e[2], e[4], e[5]};
    grid.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t entry) {
      fill(r, entry, blocks);
      run(r.near, r.far, r.count, entries);
    });
  });
}

}  // namespace

std::unique_ptr<Term> makeLatticeTerm(std::string name, const System& system, std::vector<StencilSpring> stencil) {
  return std::make_unique<LatticeTerm>(std::move(name), system, std::move(stencil));
}

}  // namespace pectora
