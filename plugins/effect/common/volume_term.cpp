#include "plugins/effect/common/cells.h"
#include "plugins/effect/common/volume_hessian.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <cmath>

namespace pectora {
namespace {

using namespace cells;

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
              .advise("Use a wider spacing of the model, or leave effect.volume out of the scene");
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
