// The energy of the springs that repeat over the grid of skin and pleura. Each is evaluated once, by the row in which it starts.
#include "kernel/physics/lattice_hessian.h"
#include "kernel/physics/stencil_row.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace pectora {
namespace {

using namespace lattice;

// What a spring of no length does: it pushes along the direction that it had at rest.
struct Degenerate {
  std::size_t near, far;
  Vec3 direction;
  double stiffness, restLength, length;
};

class LatticeTerm final : public Term {
 public:
  LatticeTerm(std::string name, const System& system, std::vector<StencilSpring> stencil)
      : name_(std::move(name)), rest_(system, std::move(stencil)), grid_(rest_.grid), aside_(grid_.stencil()) {
    std::stable_sort(aside_.begin(), aside_.end(), [](const StencilSpring& a, const StencilSpring& b) { return a.columns < b.columns; });
    for (const StencilSpring& s : aside_)
      while (beyond_ < std::size_t(std::abs(s.columns))) beyond_ += kChunk;
  }

  std::string name() const override { return name_; }

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
  std::unique_ptr<Hessian> makeHessian() const override { return std::make_unique<LatticeHessian>(rest_); }
  bool hasSprings() const override { return true; }
  void forEachSpring(const std::function<void(const Spring&)>& visit) const override {
    grid_.forEachRun([&](const Grid::Run& r, std::size_t entry) {
      const StencilSpring& s = grid_.stencil()[entry];
      for (std::size_t i = 0; i < r.count; ++i)
        visit({r.near + i, r.far + i, s.stiffnessNPerMm, restLength(r, i), s.compression});
    });
  }

 private:
  RowSprings<double> springs(const NodeVectors& positions, const Grid::Run& r, std::size_t entry) const {
    const StencilSpring& s = grid_.stencil()[entry];
    return {r.count, rowOf(positions, r.near), rowOf(positions, r.far), rowOf(rest_.nodes, r.near), rowOf(rest_.nodes, r.far),
            s.stiffnessNPerMm, s.compression};
  }
  double restLength(const Grid::Run& r, std::size_t i) const { return distance(rest_.nodes[r.near + i], rest_.nodes[r.far + i]); }

  // Calls f(Degenerate) for every spring of a block that has no direction of its own.
  template <class F>
  void forEachDegenerate(const NodeVectors& positions, int begin, int end, F&& f) const {
    grid_.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t entry) {
      const StencilSpring& s = grid_.stencil()[entry];
      for (std::size_t i = 0; i < r.count; ++i) {
        const double length = distance(positions[r.near + i], positions[r.far + i]), rest = restLength(r, i);
        if (length > kDegenerate * rest) continue;
        const double stiffness = s.stiffnessNPerMm * (length < rest ? s.compression : 1);
        f({r.near + i, r.far + i, normalized(rest_.nodes[r.far + i] - rest_.nodes[r.near + i]), stiffness, rest, length});
      }
    });
  }

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
    const Grid::Range rows = grid_.reached(begin, end);
    thread_local Room room;
    room.setSize(std::size_t(rows.end - rows.first), columns, beyond_);
    forEachRow(rows, [&](Layer layer, int row, std::size_t node) {
      const std::size_t place = room.place(layer, row - rows.first);
      subtractRows(columns, rowOf(positions, node), rowOf(rest_.nodes, node), at(room.moved, place));
      const ConstRow<float> rest = rowOf(rest_.single, node);
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
          const auto [first, last] = grid_.startsOf(s);
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
  void forEachRow(Grid::Range rows, F&& f) const {
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
  RestLattice rest_;
  const Grid& grid_;
  std::vector<StencilSpring> aside_;   // the stencil, those that end in different rows next to each other
  std::size_t beyond_ = kChunk;        // at least as many columns as springs reach
};

}  // namespace

std::unique_ptr<Term> makeLatticeTerm(std::string name, const System& system, std::vector<StencilSpring> stencil) {
  return std::make_unique<LatticeTerm>(std::move(name), system, std::move(stencil));
}

}  // namespace pectora
