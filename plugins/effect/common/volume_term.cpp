#include "plugins/effect/common/cell_grid.h"
#include "plugins/effect/common/cells.h"
#include "plugins/effect/common/volume_rows.h"

#include "kernel/physics/hessian.h"
#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <cmath>

namespace pectora {
namespace {

using namespace cells;

// The cells between two layers and two rows of the grid.
struct CellRowPlace {
  std::size_t nodes[4];   // the first ones of the rows at their corners
  std::size_t cell;       // the first one
};

// The cells of a system, row by row.
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

// The least volume that a cell has at a point of quadrature, times their number: less than nothing where the cell is folded. `x`: its corners.
double leastVolume(const Vec3 (&x)[8]) {
  double least = INFINITY;
  for (int q = 0; q < kPoints; ++q) {
    // Derivatives of the trilinear shape along columns, rows and layers.
    Vec3 along[3];
    for (int a = 0; a < 8; ++a)
      for (int j = 0; j < 3; ++j) {
        double share = (a >> j & 1) ? 1 : -1;
        for (int k = 0; k < 3; ++k)
          if (k != j) share *= (a >> k & 1) ? kPlace[q >> k & 1] : 1 - kPlace[q >> k & 1];
        along[j] += x[a] * share;
      }
    least = std::min(least, -dot(along[0], cross(along[1], along[2])));
  }
  return least;
}

// The volumes at rest, and k = kappa / V0 of the energy 1/2 k (V - V0)^2.
struct RestVolumes {
  CellRows rows;
  std::vector<double> volume, stiffness;
};

class VolumeHessian final : public Hessian {
 public:
  explicit VolumeHessian(const RestVolumes& rest) : rest_(rest), gradients_(kOnDiagonals * rest.rows.cells()) {}

  // Projected: what follows from the change of pressure alone, k g g^T with g the gradient of the volume. The pressure itself turns forces
  // with the faces that it presses on, which has as many negative eigenvalues as positive ones.
  void linearise(const NodeVectors& positions, bool projected) override {
    projected_ = projected;
    if (!projected) {
      diagonals_.resize(gradients_.size());
      pressure_.resize(rest_.rows.cells());
    }
    const std::size_t count = rest_.rows.count();
    rest_.rows.grid().forEachBlock([&](int, int begin, int end) {
      std::vector<double> room((kOnDiagonals + 1) * count);
      const CellNumbers<double> derivatives{&room[count], count};
      rest_.rows.forEachRow(begin, end, [&](const CellRowPlace& p) {
        const auto x = CellRows::corners(positions, p);
        volumes(count, x, room.data(), derivatives);
        float* g = &gradients_[kOnDiagonals * p.cell];
        for (int n = 0; n < kOnDiagonals; ++n)
          for (std::size_t i = 0; i < count; ++i) *g++ = float(std::sqrt(rest_.stiffness[p.cell + i]) * derivatives.row(n)[i]);
        if (projected) return;
        diagonalsOf(count, x, {&diagonals_[kOnDiagonals * p.cell], count});
        for (std::size_t i = 0; i < count; ++i) pressure_[p.cell + i] = float(rest_.stiffness[p.cell + i] * (room[i] - rest_.volume[p.cell + i]));
      });
    });
  }

  void multiply(const NodeVectors& v, NodeVectors& y) const override { multiplyAny(v, y); }
  void multiplySingle(const SingleVectors& v, SingleVectors& y) const override { multiplyAny(v, y); }

  void addDiagonal(std::vector<Symmetric3>& blocks) const override {
    rest_.rows.grid().forEachBlock([&](int, int begin, int end) {
      CornerGradients gradients(rest_.rows.count());
      rest_.rows.forEachRow(begin, end, [&](const CellRowPlace& p) {
        gradients.take(gradientsOf(p));
        for (int a = 0; a < 8; ++a)
          for (std::size_t i = 0; i < rest_.rows.count(); ++i) {
            const double x = double(gradients.row(a, 0)[i]), y = double(gradients.row(a, 1)[i]), z = double(gradients.row(a, 2)[i]);
            blocks[nodeOf(p, a) + i] += {x * x, x * y, x * z, y * y, y * z, z * z};
          }
      });
    });
  }

  /// Adds to each node the norms of all its blocks at a place: Gershgorin's bound of the eigenvalues.
  void addBound(const NodeVectors& positions, std::vector<double>& bound) {
    linearise(positions, true);
    const std::size_t count = rest_.rows.count();
    CornerGradients gradients(count);
    rest_.rows.forEachRow(0, rest_.rows.grid().rows(), [&](const CellRowPlace& p) {
      gradients.take(gradientsOf(p));
      for (std::size_t i = 0; i < count; ++i) {
        double norms[8], sum = 0;
        for (int a = 0; a < 8; ++a) {
          norms[a] = norm(Vec3{double(gradients.row(a, 0)[i]), double(gradients.row(a, 1)[i]), double(gradients.row(a, 2)[i])});
          sum += norms[a];
        }
        for (int a = 0; a < 8; ++a) bound[nodeOf(p, a) + i] += norms[a] * sum;
      }
    });
  }

  void forEachCoupling(const Coupling& visit) const override {
    rest_.rows.forEachRow(0, rest_.rows.grid().rows(), [&](const CellRowPlace& p) {
      Pairs pairs(*this);
      pairs.forEach(p, [&](std::size_t a, std::size_t b, std::size_t count, const float* const entries[9]) {
        for (std::size_t i = 0; i < count; ++i) {
          Matrix3 block;
          for (int e = 0; e < 9; ++e) block.m[e / 3][e % 3] = double(entries[e][i]);
          visit(a + i, b + i, block);
        }
      });
    });
  }
  // Blocks of the grid at work at one time are four rows apart, and reach one row on.
  void forEachCouplingRun(const CouplingRun& run, const Coupling&) const override {
    rest_.rows.grid().forEachBlock([&](int, int begin, int end) {
      Pairs pairs(*this);
      rest_.rows.forEachRow(begin, end, [&](const CellRowPlace& p) { pairs.forEach(p, run); });
    });
  }

 private:
  CellNumbers<const float> gradientsOf(const CellRowPlace& p) const { return {&gradients_[kOnDiagonals * p.cell], rest_.rows.count()}; }
  static std::size_t nodeOf(const CellRowPlace& p, int corner) { return p.nodes[corner >> 1] + std::size_t(corner & 1); }

  template <class Vectors>
  void multiplyAny(const Vectors& v, Vectors& y) const {
    const std::size_t count = rest_.rows.count();
    rest_.rows.grid().forEachBlock([&](int, int begin, int end) {
      std::vector<double> room(kOnDiagonals * count);
      const CellNumbers<double> numbers{room.data(), count};
      rest_.rows.forEachRow(begin, end, [&](const CellRowPlace& p) {
        const auto corners = CellRows::corners(v, p);
        projectOnto(count, gradientsOf(p), corners, numbers);
        if (!projected_) addTurned(count, &pressure_[p.cell], {&diagonals_[kOnDiagonals * p.cell], count}, corners, numbers);
        rest_.rows.addToCorners(p, numbers, y);
      });
    });
  }

  // Of a row of cells: what is on the diagonals, at the corners.
  class CornerGradients {
   public:
    explicit CornerGradients(std::size_t count) : count_(count), room_(24 * count) {}
    float* row(int corner, int axis) { return &room_[std::size_t(3 * corner + axis) * count_]; }
    void take(CellNumbers<const float> g) {
      enum { P, Q, R, S, T, U };
      for (int axis = 0; axis < 3; ++axis) {
        const auto on = [&](int diagonal) { return g.row(3 * diagonal + axis); };
        for (std::size_t i = 0; i < count_; ++i) {
          row(0, axis)[i] = -(on(P)[i] + on(S)[i] + on(U)[i]);
          row(1, axis)[i] = -on(Q)[i];
          row(2, axis)[i] = -on(R)[i];
          row(3, axis)[i] = on(U)[i];
          row(4, axis)[i] = -on(T)[i];
          row(5, axis)[i] = on(S)[i];
          row(6, axis)[i] = on(P)[i];
          row(7, axis)[i] = on(Q)[i] + on(R)[i] + on(T)[i];
        }
      }
    }

   private:
    std::size_t count_;
    std::vector<float> room_;
  };

  // The blocks between the corners of rows of cells.
  class Pairs {
   public:
    explicit Pairs(const VolumeHessian& hessian) : hessian_(hessian), count_(hessian.rest_.rows.count()), gradients_(count_), room_(9 * count_) {}
    template <class F>
    void forEach(const CellRowPlace& p, F&& run) {
      gradients_.take(hessian_.gradientsOf(p));
      const float* entries[9];
      for (std::size_t e = 0; e < 9; ++e) entries[e] = &room_[e * count_];
      for (int a = 0; a < 8; ++a)
        for (int b = a + 1; b < 8; ++b) {
          for (int e = 0; e < 9; ++e)
            for (std::size_t i = 0; i < count_; ++i) room_[std::size_t(e) * count_ + i] = gradients_.row(a, e / 3)[i] * gradients_.row(b, e % 3)[i];
          if (!hessian_.projected_) addTurnedBlocks(p, a, b);
          run(nodeOf(p, a), nodeOf(p, b), count_, entries);
        }
    }

   private:
    void addTurnedBlocks(const CellRowPlace& p, int a, int b);

    const VolumeHessian& hessian_;
    std::size_t count_;
    CornerGradients gradients_;
    std::vector<float> room_;
  };

  const RestVolumes& rest_;
  bool projected_ = true;
  std::vector<float> gradients_;   // of the volumes by their diagonals, times the root of k; row by row of cells
  std::vector<float> diagonals_, pressure_;   // unless projected
};

// Between corners a and b the pressure turns forces by the matrix [0 t2 -t1; -t2 0 t0; t1 -t0 0], with t the sum of diagonals that follows
// from the three determinants of the volume.
void VolumeHessian::Pairs::addTurnedBlocks(const CellRowPlace& place, int a, int b) {
  // At which corners the diagonals p to u end and begin, and of which of them the columns of the determinants are made.
  constexpr int kEnds[kDiagonals][2] = {{6, 0}, {7, 1}, {7, 2}, {5, 0}, {7, 4}, {3, 0}};
  constexpr bool kColumns[3][3][kDiagonals] = {{{1, 1, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0}, {0, 0, 0, 0, 0, 1}},
                                               {{1, 0, 0, 0, 0, 0}, {0, 0, 1, 1, 0, 0}, {0, 0, 0, 0, 1, 0}},
                                               {{0, 1, 0, 0, 0, 0}, {0, 0, 0, 1, 0, 0}, {0, 0, 0, 0, 1, 1}}};
  int parts[kDiagonals] = {};
  for (const auto& columns : kColumns) {
    int of[3][2] = {};   // what corners a and b are in each column
    for (int m = 0; m < 3; ++m)
      for (int n = 0; n < kDiagonals; ++n)
        for (int side = 0; side < 2; ++side) {
          const int corner = side == 0 ? a : b;
          of[m][side] += int(columns[m][n]) * (int(kEnds[n][0] == corner) - int(kEnds[n][1] == corner));
        }
    for (int m = 0; m < 3; ++m) {
      const int next = (m + 1) % 3, last = (m + 2) % 3, share = of[next][0] * of[last][1] - of[last][0] * of[next][1];
      for (int n = 0; n < kDiagonals; ++n) parts[n] += share * int(columns[m][n]);
    }
  }
  const CellNumbers<const float> diagonals{&hessian_.diagonals_[kOnDiagonals * place.cell], count_};
  const float* pressure = &hessian_.pressure_[place.cell];
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < count_; ++i) {
      float t = 0;
      for (int n = 0; n < kDiagonals; ++n) t += float(parts[n]) * diagonals.row(3 * n + axis)[i];
      t *= -pressure[i] / 12;
      const int j = (axis + 1) % 3, k = (axis + 2) % 3;
      room_[std::size_t(3 * j + k) * count_ + i] += t;
      room_[std::size_t(3 * k + j) * count_ + i] -= t;
    }
}

class VolumeTerm final : public Term {
 public:
  VolumeTerm(std::string name, const System& system, double bulk) : name_(std::move(name)), rest_{CellRows(system), {}, {}}, bound_(system.rest.size()) {
    rest_.volume.resize(rest_.rows.cells());
    rest_.stiffness.resize(rest_.rows.cells());
    const std::size_t count = rest_.rows.count();
    std::vector<double> room(kOnDiagonals * count);
    rest_.rows.forEachRow(0, rest_.rows.grid().rows(), [&](const CellRowPlace& p) {
      volumes(count, CellRows::corners(system.rest, p), &rest_.volume[p.cell], {room.data(), count});
      for (std::size_t i = 0; i < count; ++i) {
        Vec3 corners[8];
        for (int a = 0; a < 8; ++a) corners[a] = system.rest[p.nodes[a >> 1] + i + std::size_t(a & 1)];
        if (const double least = leastVolume(corners); !(least > 0)) {
          const std::size_t point = p.nodes[0] + i, columns = count + 1, rows = std::size_t(rest_.rows.grid().rows());
          throw Error("a cell of the wall has no positive volume at rest, or is folded")
              .given(fmt::format("{:.3g} mm^3 at one of its points", least / kPoints))
              .at(fmt::format("the cell inward of layer {}, row {}, column {}", point / (rows * columns), point / columns % rows, point % columns))
              .advise("Use a wider spacing of the model, or fewer cells through the wall");
        }
        rest_.stiffness[p.cell + i] = bulk / rest_.volume[p.cell + i];
      }
    });
    VolumeHessian(rest_).addBound(system.rest, bound_);
  }

  std::string name() const override { return name_; }

  double energy(const NodeVectors& positions) const override {
    double largest = 0;
    return press(positions, largest, [](const CellRowPlace&, CellNumbers<double>) {});
  }
  double evaluate(const NodeVectors& positions, NodeVectors& gradient, double& largestForce) const override {
    return press(positions, largestForce, [&](const CellRowPlace& p, CellNumbers<double> forces) { rest_.rows.addToCorners(p, forces, gradient); });
  }

  void addStiffnessBound(std::vector<double>& bound) const override {
    for (std::size_t i = 0; i < bound_.size(); ++i) bound[i] += bound_[i];
  }
  bool hasHessian() const override { return true; }
  std::unique_ptr<Hessian> makeHessian() const override { return std::make_unique<VolumeHessian>(rest_); }

 private:
  // Calls take(row of cells, forces) for every row; returns the energy.
  template <class F>
  double press(const NodeVectors& positions, double& largestForce, F&& take) const {
    const CellRows& rows = rest_.rows;
    const std::size_t count = rows.count();
    std::vector<double> energies(std::size_t(rows.grid().blocks())), largest(energies);
    rows.grid().forEachBlock([&](int block, int begin, int end) {
      std::vector<double> room((kOnDiagonals + 2) * count);
      double *twice = &room[kOnDiagonals * count], *squared = twice + count;
      const CellNumbers<double> forces{room.data(), count};
      rows.forEachRow(begin, end, [&](const CellRowPlace& p) {
        cells::press(count, CellRows::corners(positions, p), {&rest_.volume[p.cell], &rest_.stiffness[p.cell], twice, squared}, forces);
        take(p, forces);
      });
      for (std::size_t i = 0; i < count; ++i) {
        energies[std::size_t(block)] += 0.5 * twice[i];
        largest[std::size_t(block)] = std::max(largest[std::size_t(block)], squared[i]);
      }
    });
    double total = 0;
    for (std::size_t block = 0; block < energies.size(); ++block) {
      total += energies[block];
      largestForce = std::max(largestForce, std::sqrt(largest[block]));
    }
    return total;
  }

  std::string name_;
  RestVolumes rest_;
  std::vector<double> bound_;   // Gershgorin's, of the Hessian at rest
};

}  // namespace

std::unique_ptr<Term> makeVolumeTerm(std::string name, const System& system, double bulk) {
  return std::make_unique<VolumeTerm>(std::move(name), system, bulk);
}

}  // namespace pectora
