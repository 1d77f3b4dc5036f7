// Second derivatives of the spring terms, against the first.
#include "tests/kernel/physics/derivatives.h"

#include "kernel/physics/springs.h"
#include "kernel/physics/workers.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using namespace pectora;

namespace {

// A crooked two-layer grid with an anchor a pleura point, both kinds of terms, and one kind of spring that hardly pushes.
System crookedWall(int rows, int columns) {
  System system;
  system.rows = rows;
  system.columns = columns;
  const std::size_t layer = std::size_t(rows) * columns;
  system.freeNodes = 2 * layer;
  system.rest = noise(3 * layer, 1, 11);
  for (std::size_t i = 0; i < 3 * layer; ++i) {
    const std::size_t point = i % layer;
    system.rest.add(i, {8.0 * double(point % columns), i < layer ? -20.0 : i < 2 * layer ? 0.0 : 6.0, 8.0 * double(point / columns)});
  }
  system.mass.assign(system.freeNodes, 1e-3);
  system.terms.push_back(makeLatticeTerm("lattice", system,
                                         {{Layer::outer, Layer::outer, 1, 0, 0.3}, {Layer::outer, Layer::outer, 0, 1, 0.4},
                                          {Layer::outer, Layer::outer, -1, 1, 0.1, 0.2}, {Layer::outer, Layer::outer, 2, 2, 0.05},
                                          {Layer::outer, Layer::inner, 0, 0, 0.2}, {Layer::outer, Layer::inner, -2, 1, 0.07}}));
  std::vector<NodeSpring> springs;
  for (std::size_t j = 0; j < layer; ++j) springs.push_back({layer + j, 2 * layer + j, 0.5 + 0.01 * double(j)});
  system.terms.push_back(makeSpringTerm("attachment", system, springs));
  return system;
}

}  // namespace

TEST(Hessian, IsTheDerivativeOfTheGradient) {
  const System system = crookedWall(9, 7);
  const NodeVectors x = sum(system.rest, 1, noise(system.rest.size(), 4, 1));
  const auto hessian = makeHessian(system);
  hessian->linearise(x, false);
  for (unsigned seed = 2; seed < 6; ++seed) {
    const NodeVectors v = noise(x.size(), 1, seed), hv = product(*hessian, v);
    const double h = 1e-5;
    const NodeVectors up = gradientAt(system, sum(x, h, v)), down = gradientAt(system, sum(x, -h, v));
    // Single precision of the coefficients, 6e-8, times a row of about 5 N/mm.
    for (std::size_t i = 0; i < system.freeNodes; ++i) EXPECT_LT(distance((up[i] - down[i]) / (2 * h), hv[i]), 2e-6) << i;
  }
}

TEST(Hessian, IsSymmetric) {
  const System system = crookedWall(9, 7);
  const auto hessian = makeHessian(system);
  for (const bool projected : {false, true}) {
    hessian->linearise(sum(system.rest, 1, noise(system.rest.size(), 4, 1)), projected);
    NodeVectors v = noise(system.rest.size(), 1, 2), w = noise(system.rest.size(), 1, 3);
    // Of driven nodes the product means nothing.
    for (std::size_t i = system.freeNodes; i < v.size(); ++i) v.set(i, {}), w.set(i, {});
    // Single precision, 6e-8, of some 400 products of about 5 N/mm with random signs.
    EXPECT_NEAR(inner(w, product(*hessian, v)), inner(v, product(*hessian, w)), 5e-6);
  }
}

TEST(Hessian, HasNoNegativeEigenvalueWhenProjected) {
  // Squeezed to a third, the springs' lateral stiffness is negative; without projection the energy falls along some vectors.
  const System system = crookedWall(9, 7);
  NodeVectors x = system.rest;
  for (std::size_t i = 0; i < x.size(); ++i) x.set(i, x[i] * 0.3);
  const auto hessian = makeHessian(system);
  double least = 0, leastProjected = 0;
  for (unsigned seed = 1; seed < 30; ++seed) {
    const NodeVectors v = noise(x.size(), 1, seed);
    hessian->linearise(x, false);
    least = std::min(least, inner(v, product(*hessian, v)));
    hessian->linearise(x, true);
    leastProjected = std::min(leastProjected, inner(v, product(*hessian, v)));
  }
  EXPECT_LT(least, -1);
  EXPECT_GE(leastProjected, 0);
}

TEST(Hessian, EqualsItsProjectionWhereEverySpringIsStretched) {
  const System system = crookedWall(6, 6);
  NodeVectors x = system.rest;
  for (std::size_t i = 0; i < x.size(); ++i) x.set(i, x[i] * 1.5);
  const auto hessian = makeHessian(system);
  const NodeVectors v = noise(x.size(), 1, 1);
  hessian->linearise(x, false);
  const NodeVectors plain = product(*hessian, v);
  hessian->linearise(x, true);
  EXPECT_EQ(product(*hessian, v).x, plain.x);
}

TEST(Hessian, DiagonalBlocksAreItsOwn) {
  const System system = crookedWall(5, 6);
  const auto hessian = makeHessian(system);
  hessian->linearise(sum(system.rest, 1, noise(system.rest.size(), 4, 1)), false);
  std::vector<Symmetric3> blocks(system.rest.size());
  hessian->addDiagonal(blocks);
  for (std::size_t i = 0; i < blocks.size(); i += 7)
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
      NodeVectors unit(system.rest.size());
      unit.set(i, axis);
      // Single precision, 6e-8, of a row of about 5 N/mm.
      EXPECT_LT(distance(product(*hessian, unit)[i], blocks[i] * axis), 5e-7);
    }
}

TEST(Hessian, IsTheSumOfItsBlocks) {
  const System system = crookedWall(6, 5);
  const auto hessian = makeHessian(system);
  hessian->linearise(sum(system.rest, 1, noise(system.rest.size(), 4, 1)), true);
  const NodeVectors v = noise(system.rest.size(), 1, 2);
  const NodeVectors y = productOfBlocks(*hessian, v);
  const NodeVectors expected = product(*hessian, v);
  for (std::size_t i = 0; i < system.freeNodes; ++i) EXPECT_LT(distance(y[i], expected[i]), 3e-6) << i;   // single precision
}

TEST(Hessian, StaysFiniteWhenPointsCoincide) {
  const System system = crookedWall(5, 6);
  NodeVectors x = system.rest;
  for (std::size_t i = 0; i < x.size(); ++i) x.set(i, {1, 2, 3});
  const auto hessian = makeHessian(system);
  for (const bool projected : {false, true}) {
    hessian->linearise(x, projected);
    const NodeVectors v = noise(x.size(), 1, 2), y = product(*hessian, v);
    for (std::size_t i = 0; i < x.size(); ++i) ASSERT_TRUE(isFinite(y[i]));
    EXPECT_GT(inner(v, y), 0);
  }
}

TEST(Hessian, GivesTheSameBitsForAnyNumberOfThreads) {
  const System system = crookedWall(45, 31);
  const NodeVectors x = sum(system.rest, 1, noise(system.rest.size(), 4, 1)), v = noise(system.rest.size(), 1, 2);
  const int before = threads();
  std::vector<NodeVectors> products;
  for (const int count : {1, 2, 8}) {
    setThreads(count);
    const auto hessian = makeHessian(system);
    hessian->linearise(x, true);
    products.push_back(product(*hessian, v));
    EXPECT_EQ(products.back().x, products.front().x) << count;
    EXPECT_EQ(products.back().z, products.front().z) << count;
  }
  setThreads(before);
}

TEST(Symmetric3, InverseUndoesIt) {
  const Symmetric3 a{4, 1, -0.5, 3, 0.7, 2};
  for (const Vec3 v : {Vec3{1, 2, 3}, Vec3{-1, 0, 0.5}}) EXPECT_LT(distance(inverse(a) * (a * v), v), 1e-14);
}

TEST(Symmetric3, InverseIsPositiveWhereTheMatrixIsNot) {
  for (const Symmetric3& a : {Symmetric3{1, 0, 0, 0, 0, 0}, Symmetric3{2, 0, 0, -1, 0, 3}, Symmetric3{-1, 0, 0, -1, 0, -1}, Symmetric3{}}) {
    const Symmetric3 b = inverse(a);
    for (const Vec3 v : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{1, 1, -1}}) {
      EXPECT_GT(dot(v, b * v), 0);
      EXPECT_TRUE(isFinite(b * v));
    }
  }
}
