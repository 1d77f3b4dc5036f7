// The cells' energy and its derivatives.
#include "tests/plugins/effect/common/block.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pectora;

namespace {

// Crooked cells of several moduli; with mu = 0 only their volume counts.
System crooked(int layers, int rows, int columns, double shear) {
  System system = block(layers, rows, columns, {8.0 * (columns - 1), 6.0 * (layers - 1), 8.0 * (rows - 1)});
  system.rest = sum(system.rest, 1, noise(system.rest.size(), 0.8, 11));
  if (shear == 0) {
    system.terms.push_back(makeVolumeTerm("volume", system, 0.06));
    return system;
  }
  std::vector<CellModuli> moduli;
  for (std::size_t i = 0; i < cellsOf(system); ++i) moduli.push_back({shear * (1 + 0.1 * double(i % 5)), 0.05 + 0.01 * double(i % 3)});
  system.terms.push_back(makeCellTerm("cells", system, moduli));
  return system;
}

NodeVectors transformed(const NodeVectors& x, const double (&f)[3][3], Vec3 shift) {
  NodeVectors y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 p = x[i];
    y.set(i, Vec3{f[0][0] * p.x + f[0][1] * p.y + f[0][2] * p.z, f[1][0] * p.x + f[1][1] * p.y + f[1][2] * p.z,
                  f[2][0] * p.x + f[2][1] * p.y + f[2][2] * p.z} + shift);
  }
  return y;
}

}  // namespace

TEST(Cells, VolumeAloneIsWhatTheBulkModulusAddsToTissue) {
  System system = block(3, 4, 11, {80, 12, 24});
  system.rest = sum(system.rest, 1, noise(system.rest.size(), 0.8, 11));
  const std::vector<CellModuli> soft(cellsOf(system), {0.004, 0}), whole(soft.size(), {0.004, 0.06});
  const auto alone = makeVolumeTerm("volume", system, 0.06), tissue = makeCellTerm("whole", system, whole), shear = makeCellTerm("soft", system, soft);
  // Some cells are turned inside out.
  const NodeVectors x = sum(system.rest, 1, noise(system.rest.size(), 2.5, 1));
  EXPECT_NEAR(alone->energy(x), tissue->energy(x) - shear->energy(x), 1e-12 * tissue->energy(x));
}

class CellKinds : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(TissueAndVolume, CellKinds, testing::Values(0.004, 0.0));

TEST_P(CellKinds, GradientIsTheDerivativeOfTheEnergy) {
  const System system = crooked(3, 4, 11, GetParam());
  // Up to 2.5 mm in cells of 6 mm: some are turned inside out.
  const NodeVectors x = sum(system.rest, 1, noise(system.rest.size(), 2.5, 1)), gradient = gradientAt(system, x);
  for (unsigned seed = 2; seed < 8; ++seed) {
    const NodeVectors v = noise(x.size(), 1, seed);
    const double h = 1e-4, slope = (system.energy(sum(x, h, v)) - system.energy(sum(x, -h, v))) / (2 * h);
    // Central differences: h^2 times the third derivative, and rounding of the energy over h.
    EXPECT_NEAR(slope, inner(gradient, v), 1e-6 * std::sqrt(inner(gradient, gradient) * double(x.size())));
  }
}

TEST_P(CellKinds, HessianIsTheDerivativeOfTheGradient) {
  const System system = crooked(3, 4, 11, GetParam());
  const NodeVectors x = sum(system.rest, 1, noise(system.rest.size(), 2, 1));
  const auto hessian = makeHessian(system);
  hessian->linearise(x, false);
  for (unsigned seed = 2; seed < 6; ++seed) {
    const NodeVectors v = noise(x.size(), 1, seed), hv = product(*hessian, v);
    const double h = 1e-5;
    const NodeVectors up = gradientAt(system, sum(x, h, v)), down = gradientAt(system, sum(x, -h, v));
    // Single precision of 27 blocks of about 0.5 N/mm.
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT(distance((up[i] - down[i]) / (2 * h), hv[i]), 2e-6) << i;
  }
}

TEST_P(CellKinds, ProjectedHessianHasNoNegativeEigenvalue) {
  const System system = crooked(2, 3, 3, GetParam());
  const auto hessian = makeHessian(system);
  double least = 0, leastProjected = 0, largest = 0;
  for (unsigned seed = 1; seed < 6; ++seed) {
    // Squeezed to half, and noise that turns cells inside out. The whole matrix, and its least eigenvalue by power iteration.
    NodeVectors x = sum(system.rest, 1, noise(system.rest.size(), 2.5, seed));
    for (std::size_t i = 0; i < x.size(); ++i) x.set(i, x[i] * 0.5);
    for (const bool projected : {false, true}) {
      hessian->linearise(x, projected);
      double top = 0;
      NodeVectors v = noise(x.size(), 1, 77);
      for (int n = 0; n < 300; ++n) {
        NodeVectors y = product(*hessian, v);
        top = std::sqrt(inner(y, y) / inner(v, v));
        v = sum(NodeVectors(x.size()), 1 / std::sqrt(inner(y, y)), y);
      }
      largest = std::max(largest, top);
      v = noise(x.size(), 1, 78);
      double eigenvalue = 0;
      for (int n = 0; n < 3000; ++n) {
        const NodeVectors y = sum(product(*hessian, v), -top, v);
        eigenvalue = inner(v, product(*hessian, v)) / inner(v, v);
        v = sum(NodeVectors(x.size()), 1 / std::sqrt(inner(y, y)), y);
      }
      (projected ? leastProjected : least) = std::min(projected ? leastProjected : least, eigenvalue);
    }
  }
  EXPECT_LT(least, -1e-3 * largest);
  EXPECT_GT(leastProjected, -1e-6 * largest) << "single precision";
}

TEST_P(CellKinds, ProjectionChangesNothingAtRest) {
  // At rest no direction has a negative curvature, so the two agree up to single precision.
  const System system = crooked(3, 4, 5, GetParam());
  const auto hessian = makeHessian(system);
  const NodeVectors v = noise(system.rest.size(), 1, 1);
  hessian->linearise(system.rest, false);
  const NodeVectors plain = product(*hessian, v);
  hessian->linearise(system.rest, true);
  const NodeVectors projected = product(*hessian, v);
  for (std::size_t i = 0; i < v.size(); ++i) EXPECT_LT(distance(plain[i], projected[i]), 1e-6);
}

TEST_P(CellKinds, HessianIsSymmetricAndItsDiagonalBlocksAreItsOwn) {
  const System system = crooked(3, 5, 6, GetParam());
  const auto hessian = makeHessian(system);
  hessian->linearise(sum(system.rest, 1, noise(system.rest.size(), 2, 1)), true);
  const NodeVectors v = noise(system.rest.size(), 1, 2), w = noise(system.rest.size(), 1, 3);
  EXPECT_NEAR(inner(w, product(*hessian, v)), inner(v, product(*hessian, w)), 1e-12);
  std::vector<Symmetric3> blocks(system.rest.size());
  hessian->addDiagonal(blocks);
  for (std::size_t i = 0; i < blocks.size(); i += 7)
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
      NodeVectors unit(system.rest.size());
      unit.set(i, axis);
      EXPECT_LT(distance(product(*hessian, unit)[i], blocks[i] * axis), 1e-7);   // single precision of up to 0.5 N/mm
    }
}

TEST_P(CellKinds, HessianIsTheSumOfItsBlocksAlsoInSinglePrecision) {
  const System system = crooked(3, 5, 6, GetParam());
  const auto hessian = makeHessian(system);
  for (const bool projected : {true, false}) {
    hessian->linearise(sum(system.rest, 1, noise(system.rest.size(), 2, 1)), projected);
    const NodeVectors v = noise(system.rest.size(), 1, 2), expected = product(*hessian, v);
    const NodeVectors y = productOfBlocks(*hessian, v);
    SingleVectors single(v.size()), products(v.size());
    for (std::size_t i = 0; i < v.size(); ++i) single.set(i, v[i]);
    hessian->multiplySingle(single, products);
    for (std::size_t i = 0; i < v.size(); ++i) {
      EXPECT_LT(distance(y[i], expected[i]), 1e-6) << i;                                     // 27 blocks in single precision
      EXPECT_LT(distance(products[i], expected[i]), 1e-6 * (1 + norm(expected[i]))) << i;
    }
  }
}

TEST_P(CellKinds, StiffnessBoundExceedsEveryEigenvalueAtRest) {
  const System system = crooked(3, 5, 6, GetParam());
  const std::vector<double> bound = system.stiffnessBound();
  const auto hessian = makeHessian(system);
  hessian->linearise(system.rest, false);
  // Power iteration for D^-1 H, whose largest eigenvalue must stay below 1.
  NodeVectors v = noise(system.rest.size(), 1, 5);
  double quotient = 0;
  for (int n = 0; n < 200; ++n) {
    const NodeVectors y = product(*hessian, v);
    double below = 0;
    for (std::size_t i = 0; i < v.size(); ++i) below += bound[i] * dot(v[i], v[i]);
    quotient = inner(v, y) / below;
    for (std::size_t i = 0; i < v.size(); ++i) v.set(i, y[i] / bound[i]);
    v = sum(NodeVectors(v.size()), 1 / std::sqrt(inner(v, v)), v);
  }
  EXPECT_LT(quotient, 1);
  EXPECT_GT(quotient, 0.1) << "a bound that is far too large makes explicit solvers slow";
}

TEST_P(CellKinds, RotationAndTranslationCostNothing) {
  const System system = crooked(3, 4, 9, GetParam());
  const double c = std::cos(0.7), s = std::sin(0.7), k = std::cos(1.9), t = std::sin(1.9);
  const double turn[3][3] = {{c, -s * k, s * t}, {s, c * k, -c * t}, {0, t, k}};
  const NodeVectors x = transformed(system.rest, turn, {100, -50, 7});
  EXPECT_NEAR(system.energy(x), 0, 1e-12);
  NodeVectors gradient = gradientAt(system, x);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT(norm(gradient[i]), 1e-13);
  // And they turn the forces along.
  const NodeVectors bent = sum(system.rest, 1, noise(x.size(), 1.5, 3));
  EXPECT_NEAR(system.energy(bent), system.energy(transformed(bent, turn, {100, -50, 7})), 1e-12 * system.energy(bent) * 100);
}

TEST_P(CellKinds, GivesTheSameBitsForAnyNumberOfThreads) {
  const System system = crooked(4, 23, 31, GetParam());
  const NodeVectors x = sum(system.rest, 1, noise(system.rest.size(), 2, 1)), v = noise(system.rest.size(), 1, 2);
  const int before = threads();
  std::vector<NodeVectors> gradients, products;
  std::vector<double> energies;
  for (const int count : {1, 2, 8}) {
    setThreads(count);
    const auto hessian = makeHessian(system);
    hessian->linearise(x, true);
    gradients.push_back(gradientAt(system, x));
    products.push_back(product(*hessian, v));
    energies.push_back(system.energy(x));
    EXPECT_EQ(energies.back(), energies.front());
    EXPECT_EQ(gradients.back().y, gradients.front().y) << count;
    EXPECT_EQ(products.back().x, products.front().x) << count;
  }
  setThreads(before);
}

TEST_P(CellKinds, StaysFiniteWhenACellCollapses) {
  const System system = crooked(3, 4, 5, GetParam());
  NodeVectors point(system.rest.size()), flat = system.rest, line = system.rest;
  for (std::size_t i = 0; i < flat.size(); ++i) point.set(i, {1, 2, 3}), flat.y[i] = 0, line.set(i, {flat.x[i], 0, 0});
  for (const NodeVectors& x : {point, flat, line}) {
    EXPECT_TRUE(std::isfinite(system.energy(x)));
    const auto hessian = makeHessian(system);
    for (const bool projected : {false, true}) {
      hessian->linearise(x, projected);
      const NodeVectors v = noise(x.size(), 1, 2), y = product(*hessian, v), gradient = gradientAt(system, x);
      for (std::size_t i = 0; i < x.size(); ++i) ASSERT_TRUE(isFinite(y[i]) && isFinite(gradient[i]));
    }
  }
}

TEST(Cells, HomogeneousStrainHasTheClosedForm) {
  // mu/2 (I - 3) - mu (J - 1) + (lambda + mu)/2 (J - 1)^2, lambda + mu = kappa + mu/3, whatever the shape of the cells.
  System system = block(4, 5, 6, {40, 18, 32});
  NodeVectors bent = sum(system.rest, 1, noise(system.rest.size(), 0.8, 4));
  // The outside stays a box, so that its volume is known.
  for (int l = 0; l < 4; ++l)
    for (int r = 0; r < 5; ++r)
      for (int c = 0; c < 6; ++c)
        if (const std::size_t i = system.node(l, r * 6 + c); l > 0 && l < 3 && r > 0 && r < 4 && c > 0 && c < 5) system.rest.set(i, bent[i]);
  const CellModuli m = moduliOf(10, 0.45);
  system.terms.push_back(makeCellTerm("cells", system, std::vector<CellModuli>(cellsOf(system), m)));
  const double f[3][3] = {{1.2, 0.3, -0.1}, {0.05, 0.8, 0.2}, {0.1, -0.2, 1.1}};
  double square = 0;
  for (const auto& row : f)
    for (const double e : row) square += e * e;
  const double j = 1.2 * (0.8 * 1.1 + 0.2 * 0.2) - 0.3 * (0.05 * 1.1 - 0.2 * 0.1) - 0.1 * (-0.05 * 0.2 - 0.8 * 0.1);
  const double expected = 40 * 18 * 32 * (m.shear / 2 * (square - 3) - m.shear * (j - 1) + (m.bulk + m.shear / 3) / 2 * (j - 1) * (j - 1));
  const NodeVectors x = transformed(system.rest, f, {});
  EXPECT_NEAR(system.energy(x), expected, 1e-11 * expected);
  // The patch test: no force inside.
  const NodeVectors gradient = gradientAt(system, x);
  for (int l = 1; l < 3; ++l)
    for (int r = 1; r < 4; ++r)
      for (int c = 1; c < 5; ++c) EXPECT_LT(norm(gradient[system.node(l, r * 6 + c)]), 1e-14);
}

TEST(Cells, VolumeAloneGivesTheVolumeOfThePrism) {
  // A cell between two layers, sheared at constant volume and then a quarter thicker.
  System system = block(2, 2, 2, {8, 20, 8});
  system.terms.push_back(makeCellTerm("volume", system, {{0, 0.1}}));
  NodeVectors x = system.rest;
  for (std::size_t i = 0; i < x.size(); ++i) x.x[i] += 0.7 * x.y[i];
  EXPECT_NEAR(system.energy(x), 0, 1e-14);
  for (std::size_t i = 0; i < x.size(); ++i) x.y[i] *= 1.25;
  EXPECT_NEAR(system.energy(x), 0.5 * 0.1 * 8 * 20 * 8 * 0.25 * 0.25, 1e-12);
}

TEST(Cells, RefuseACellWithoutVolumeAndNameIt) {
  System system = block(3, 4, 5, {32, 12, 24});
  const std::vector<CellModuli> moduli(cellsOf(system), {0.01, 0.1});
  // A point of the middle layer pushed through the pleura.
  system.rest.add(system.node(1, 2 * 5 + 3), {0, 30, 0});
  try {
    makeCellTerm("cells", system, moduli);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("row 1, column 2"), std::string::npos) << error.what();
  }
}
