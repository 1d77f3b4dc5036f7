#include "plugins/effect/common/cell_hessian.h"
#include "plugins/effect/common/cell_rows.h"
#include "plugins/effect/common/cells.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <cmath>

namespace pectora {
namespace {

using namespace cells;

class CellTerm final : public Term {
 public:
  CellTerm(std::string name, const System& system, const std::vector<CellModuli>& moduli)
      : name_(std::move(name)), rest_{Grid(system), system.rest, {}}, grid_(rest_.grid), bound_(system.rest.size()) {
    rest_.packs.resize(grid_.packs());
    grid_.forEachPack(0, grid_.rows(), [&](const Grid::Place& p) { fill(p, moduli); });
    CellHessian hessian(rest_);
    hessian.linearise(system.rest, true);
    hessian.addRowNorms(bound_);
  }

  std::string name() const override { return name_; }

  double energy(const NodeVectors& positions) const override {
    std::vector<double> energies(grid_.blocks());
    grid_.forEachBlock([&](int block, int begin, int end) {
      grid_.forEachPack(begin, end, [&](const Grid::Place& p) { energies[block] += cellEnergy(rest_.run(positions, p), rest_.packs[p.index]); });
    });
    double total = 0;
    for (const double e : energies) total += e;
    return total;
  }

  double evaluate(const NodeVectors& positions, NodeVectors& gradient, double& largestForce) const override {
    std::vector<double> energies(grid_.blocks()), largest(grid_.blocks());
    grid_.forEachBlock([&](int block, int begin, int end) {
      grid_.forEachPack(begin, end, [&](const Grid::Place& p) {
        ForceRows rows;
        for (int k = 0; k < 4; ++k) {
          const std::size_t first = grid_.node(p.l + (k >> 1), p.r + (k & 1), p.c);
          rows.rows[0][k] = &gradient.x[first], rows.rows[1][k] = &gradient.y[first], rows.rows[2][k] = &gradient.z[first];
        }
        energies[block] += cellForces(rest_.run(positions, p), rest_.packs[p.index], rows, largest[block]);
      });
    });
    double total = 0;
    for (int block = 0; block < grid_.blocks(); ++block) {
      total += energies[block];
      largestForce = std::max(largestForce, std::sqrt(largest[block]));
    }
    return total;
  }

  void addStiffnessBound(std::vector<double>& bound) const override {
    for (std::size_t i = 0; i < bound_.size(); ++i) bound[i] += bound_[i];
  }
  bool hasHessian() const override { return true; }
  std::unique_ptr<Hessian> makeHessian() const override { return std::make_unique<CellHessian>(rest_); }

 private:
  void fill(const Grid::Place& place, const std::vector<CellModuli>& moduli);

  std::string name_;
  RestCells rest_;
  const Grid& grid_;
  std::vector<double> bound_;   // Gershgorin's, of the Hessian at rest
};

// The shape functions' derivatives at rest, inverted. The three directions of a cell (columns, rows, inwards) are left-handed.
void CellTerm::fill(const Grid::Place& place, const std::vector<CellModuli>& moduli) {
  RestPack& pack = rest_.packs[place.index];
  Pack d[3][3][4];
  const CornerRows corners = grid_.corners(rest_.positions, place);
  for (int i = 0; i < 3; ++i) {
    Pack v[kCorners];
    load(corners, place.count, i, v);
    derivatives(v, d[i]);
  }
  Pack volume{};
  for (int q = 0; q < kPoints; ++q) {
    Pack x[3][3], c[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) x[i][j] = d[i][j][across(j, q)];
    cofactors(x, c);
    const Pack det = determinant(x, c);
    for (int lane = 0; lane < place.count; ++lane) {
      pack.weight[q][lane] = -det[lane] / kPoints;
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) pack.inverse[q][j][k][lane] = c[k][j][lane] / det[lane];
    }
    volume += pack.weight[q];
  }
  for (int lane = 0; lane < place.count; ++lane) {
    double least = pack.weight[0][lane];
    for (int q = 1; q < kPoints; ++q) least = std::min(least, pack.weight[q][lane]);
    if (!(least > 0))
      throw Error("a cell of the wall has no positive volume at rest, or is folded")
          .given(fmt::format("{:.3g} mm^3 at one of its points", least))
          .at(fmt::format("the cell inward of layer {}, row {}, column {}", place.l, place.r, place.c + lane))
          .advise("Use a wider spacing of the model, or fewer cells through the wall");
    const CellModuli& m = moduli[(std::size_t(place.l) * (grid_.rows() - 1) + place.r) * (grid_.columns() - 1) + place.c + lane];
    pack.inverseVolume[lane] = 1 / volume[lane];
    pack.shear[lane] = m.shear;
    pack.bulk[lane] = m.bulk;
  }
}

}  // namespace

CellModuli moduliOf(double youngsModulusKPa, double nu) {
  const double e = 1e-3 * youngsModulusKPa;
  return {e / (2 * (1 + nu)), e / (3 * (1 - 2 * nu))};
}

std::unique_ptr<Term> makeCellTerm(std::string name, const System& system, const std::vector<CellModuli>& cells) {
  return std::make_unique<CellTerm>(std::move(name), system, cells);
}

}  // namespace pectora
