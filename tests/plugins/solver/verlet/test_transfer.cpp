// The flat lattice's answer to a wave of the inner layer, against the closed form (science: T(q) = K_oo^-1 K_oi, whose normal
// part is the average of the inner layer weighted by the cross springs).
#include "plugins/solver/verlet/verlet.h"

#include "kernel/physics/calibration.h"
#include "kernel/physics/springs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace pectora;

namespace {

constexpr double kSpacing = 8, kThickness = 20, kAmplitude = 1e-3;
constexpr int kRows = 21, kColumns = 121;

// Skin free, pleura driven; springs as the effects make them.
System flatLattice() {
  System system;
  system.rows = kRows;
  system.columns = kColumns;
  system.freeNodes = std::size_t(kRows) * kColumns;
  system.rest = NodeVectors(2 * system.freeNodes);
  for (std::size_t i = 0; i < system.freeNodes; ++i) {
    const double x = kSpacing * double(i % kColumns), z = kSpacing * double(i / kColumns);
    system.rest.set(i, {x, -kThickness, z});
    system.rest.set(system.freeNodes + i, {x, 0, z});
  }
  system.mass.assign(system.freeNodes, 1e-3);
  std::vector<StencilSpring> stencil;
  const CrossStiffness cross = calibrateCross(0.01, kSpacing, kSpacing, kThickness);
  for (int i = 0; i < 25; ++i) stencil.push_back({Layer::outer, Layer::inner, i / 5 - 2, i % 5 - 2, cross.stiffness[i]});
  const LayerStiffness skin = calibrateLayer(0.36, kSpacing, kSpacing, 0);
  stencil.push_back({Layer::outer, Layer::outer, 1, 0, skin.stretchRows});
  stencil.push_back({Layer::outer, Layer::outer, 0, 1, skin.stretchColumns});
  stencil.push_back({Layer::outer, Layer::outer, 1, 1, skin.shear});
  stencil.push_back({Layer::outer, Layer::outer, -1, 1, skin.shear});
  system.terms.push_back(makeLatticeTerm("lattice", system, stencil));
  return system;
}

// The normal transfer function: 5 x 5 weighted cosine average.
double closedForm(double wavelength) {
  const CrossStiffness cross = calibrateCross(0.01, kSpacing, kSpacing, kThickness);
  double sum = 0, wave = 0;
  for (int i = 0; i < 25; ++i) {
    const double r = (i / 5 - 2) * kSpacing, c = (i % 5 - 2) * kSpacing;
    const double weight = cross.stiffness[i] / (r * r + c * c + kThickness * kThickness);
    sum += weight;
    wave += weight * std::cos(2 * std::numbers::pi / wavelength * c);
  }
  return wave / sum;
}

// Height of the skin's wave over that of the pleura, at the middle of the lattice.
double measured(double wavelength) {
  const System system = flatLattice();
  NodeVectors x = system.rest;
  const double middle = kSpacing * (kColumns / 2);
  for (std::size_t i = 0; i < system.freeNodes; ++i)
    x.y[system.freeNodes + i] -= kAmplitude * std::cos(2 * std::numbers::pi / wavelength * (system.rest.x[i] - middle));
  const double omega = std::sqrt(frequencyBoundSquared(system, system.mass));
  Verlet verlet(system, system.mass, x, 0.5 * stableStep(omega, 0.05 * omega));
  for (int n = 0; n < 3000; ++n) verlet.step(0.05 * omega);
  const std::size_t center = std::size_t(kRows / 2) * kColumns + kColumns / 2;
  return (-kThickness - verlet.positions().y[center]) / kAmplitude;
}

}  // namespace

TEST(Transfer, ClosedFormHasThePublishedFigures) {
  // Lattice a = 8, H = 20: three decimals.
  EXPECT_NEAR(closedForm(400), .984, 6e-4);
  EXPECT_NEAR(closedForm(200), .935, 6e-4);
  EXPECT_NEAR(closedForm(120), .826, 6e-4);
  EXPECT_NEAR(closedForm(80), .633, 6e-4);
  EXPECT_NEAR(closedForm(50), .216, 6e-4);
}

TEST(Transfer, OfTheSolvedLatticeIsTheClosedForm) {
  // At 1e-3 mm the springs' geometric terms are 1e-4 of the linear ones.
  for (const double wavelength : {200.0, 120.0, 80.0, 50.0}) EXPECT_NEAR(measured(wavelength), closedForm(wavelength), 1e-3) << wavelength;
}
