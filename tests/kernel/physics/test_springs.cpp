#include "kernel/physics/springs.h"
#include "kernel/physics/workers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace pectora;

namespace {

// A slightly crooked two-layer grid with anchors on the last nodes.
System crookedGrid(int rows, int columns, int anchors) {
  System system;
  system.rows = rows;
  system.columns = columns;
  system.freeNodes = 2 * std::size_t(rows) * columns;
  system.rest = NodeVectors(system.freeNodes + anchors);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-1, 1);
  for (std::size_t i = 0; i < system.rest.size(); ++i) {
    const std::size_t point = i % (std::size_t(rows) * columns);
    const double depth = i < system.freeNodes / 2 ? -20 : i < system.freeNodes ? 0 : 6;
    system.rest.set(i, {8.0 * double(point % columns) + jitter(random), depth + jitter(random), 8.0 * double(point / columns) + jitter(random)});
  }
  system.mass.assign(system.freeNodes, 1e-3);
  return system;
}

std::vector<StencilSpring> someStencil() {
  return {{Layer::outer, Layer::outer, 1, 0, 0.3}, {Layer::outer, Layer::outer, 0, 1, 0.4}, {Layer::outer, Layer::outer, -1, 1, 0.1, 0.2},
          {Layer::outer, Layer::outer, 2, 2, 0.05}, {Layer::outer, Layer::inner, 0, 0, 0.2}, {Layer::outer, Layer::inner, -2, 1, 0.07}};
}

NodeVectors perturbed(const System& system, double amplitude, unsigned seed) {
  NodeVectors x = system.rest;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-amplitude, amplitude);
  for (std::size_t i = 0; i < x.size(); ++i) x.add(i, {jitter(random), jitter(random), jitter(random)});
  return x;
}

// The largest difference between the gradient and central differences of the energy, over all coordinates of some nodes.
double gradientError(const System& system, const Term& term, NodeVectors x) {
  NodeVectors gradient(x.size());
  double largest = 0, error = 0;
  term.evaluate(x, gradient, largest);
  const double h = 1e-5;
  for (std::size_t i = 0; i < system.freeNodes; i += 7) {
    for (std::vector<double> NodeVectors::*axis : {&NodeVectors::x, &NodeVectors::y, &NodeVectors::z}) {
      double& coordinate = (x.*axis)[i];
      const double here = coordinate;
      coordinate = here + h;
      const double up = term.energy(x);
      coordinate = here - h;
      const double down = term.energy(x);
      coordinate = here;
      error = std::max(error, std::abs((up - down) / (2 * h) - (gradient.*axis)[i]));
    }
  }
  return error;
}

}  // namespace

TEST(LatticeTerm, GradientIsTheDerivativeOfItsEnergy) {
  const System system = crookedGrid(6, 9, 0);
  const auto term = makeLatticeTerm("all", system, someStencil());
  // Rounding of the energy (about 100 N mm) over 2 h leaves 1e-9; forces are of order 1 N.
  EXPECT_LT(gradientError(system, *term, perturbed(system, 3, 1)), 1e-7);
}

TEST(SpringTerm, GradientIsTheDerivativeOfItsEnergy) {
  const System system = crookedGrid(4, 5, 20);
  std::vector<NodeSpring> springs;
  for (std::size_t j = 0; j < 20; ++j) springs.push_back({20 + j, 40 + j, 0.5 + 0.1 * double(j)});
  const auto term = makeSpringTerm("attachment", system, springs);
  EXPECT_LT(gradientError(system, *term, perturbed(system, 3, 2)), 1e-7);
}

TEST(LatticeTerm, HasNoEnergyAndNoForceAtRest) {
  const System system = crookedGrid(6, 9, 0);
  const auto term = makeLatticeTerm("all", system, someStencil());
  NodeVectors gradient(system.rest.size());
  double largest = 0;
  EXPECT_EQ(term->evaluate(system.rest, gradient, largest), 0);
  EXPECT_EQ(largest, 0);
}

TEST(LatticeTerm, EqualsTheSameSpringsGivenOneByOne) {
  const System system = crookedGrid(5, 6, 0);
  std::vector<StencilSpring> stencil = someStencil();
  std::erase_if(stencil, [](const StencilSpring& s) { return s.compression < 1; });
  const auto lattice = makeLatticeTerm("all", system, stencil);
  std::vector<NodeSpring> list;
  for (const StencilSpring& s : stencil)
    for (int r = 0; r < 5; ++r)
      for (int c = 0; c < 6; ++c) {
        const int row = r + s.rows, column = c + s.columns;
        if (row < 0 || row >= 5 || column < 0 || column >= 6) continue;
        list.push_back({std::size_t(r * 6 + c) + (s.from == Layer::inner ? 30 : 0), std::size_t(row * 6 + column) + (s.to == Layer::inner ? 30 : 0), s.stiffnessNPerMm});
      }
  const auto springs = makeSpringTerm("list", system, list);
  const NodeVectors x = perturbed(system, 4, 3);
  NodeVectors a(x.size()), b(x.size());
  double largestA = 0, largestB = 0;
  EXPECT_NEAR(lattice->evaluate(x, a, largestA), springs->evaluate(x, b, largestB), 1e-10);
  EXPECT_NEAR(largestA, largestB, 1e-12);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT(distance(a[i], b[i]), 1e-11);
  std::vector<double> boundA(x.size()), boundB(x.size());
  lattice->addStiffnessBound(boundA);
  springs->addStiffnessBound(boundB);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(boundA[i], boundB[i], 1e-12);
}

TEST(LatticeTerm, JoinsSkinAndPleuraAcrossTheLayersBetween) {
  System system = crookedGrid(4, 5, 0);
  system.layers = 3;
  system.rest = perturbed(crookedGrid(4, 5, 20), 1, 8);
  const auto term = makeLatticeTerm("direct", system, {{Layer::outer, Layer::inner, 1, -1, 0.3}});
  term->forEachSpring([&](const Spring& s) {
    EXPECT_EQ(s.b, s.a + 2 * 20 + 5 - 1);
    EXPECT_EQ(s.restLength, distance(system.rest[s.a], system.rest[s.b]));
  });
}

TEST(LatticeTerm, IsUnchangedByRotationAndTranslation) {
  const System system = crookedGrid(6, 9, 0);
  const auto term = makeLatticeTerm("all", system, someStencil());
  const NodeVectors x = perturbed(system, 3, 4);
  NodeVectors turned(x.size());
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (std::size_t i = 0; i < x.size(); ++i) turned.set(i, {c * x.x[i] - s * x.y[i] + 100, s * x.x[i] + c * x.y[i] - 50, x.z[i] + 7});
  EXPECT_NEAR(term->energy(x), term->energy(turned), 1e-9);
}

TEST(LatticeTerm, GivesTheSameBitsForAnyNumberOfThreads) {
  const System system = crookedGrid(40, 31, 0);
  const auto term = makeLatticeTerm("all", system, someStencil());
  const NodeVectors x = perturbed(system, 3, 5);
  const int before = threads();
  NodeVectors one(x.size());
  double largest = 0;
  setThreads(1);
  const double energy = term->evaluate(x, one, largest);
  for (int count : {2, 8}) {
    setThreads(count);
    NodeVectors other(x.size());
    double otherLargest = 0;
    EXPECT_EQ(term->evaluate(x, other, otherLargest), energy);
    EXPECT_EQ(otherLargest, largest);
    EXPECT_EQ(other.x, one.x);
    EXPECT_EQ(other.y, one.y);
    EXPECT_EQ(other.z, one.z);
  }
  setThreads(before);
}

TEST(LatticeTerm, RoughForcesAreThoseOfSinglePrecisionEvenFarFromTheOrigin) {
  System system = crookedGrid(20, 23, 0);
  for (std::size_t i = 0; i < system.rest.size(); ++i) system.rest.add(i, {-300, 200, -1200});
  const auto term = makeLatticeTerm("lattice", system, someStencil());
  for (const double amplitude : {3.0, 1e-3}) {
    const NodeVectors x = perturbed(system, amplitude, 5);
    NodeVectors exact(x.size()), rough(x.size());
    double largest = 0, largestRough = 0;
    const double energy = term->evaluate(x, exact, largest), energyRough = term->evaluateRoughly(x, rough, largestRough);
    // Some ten roundings of 6e-8 a spring; a dozen springs a point.
    EXPECT_NEAR(energyRough, energy, 1e-5 * energy);
    EXPECT_NEAR(largestRough, largest, 1e-5 * largest);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT(distance(rough[i], exact[i]), 1e-5 * largest) << amplitude;
  }
}

TEST(LatticeTerm, RoughForcesAreRightOnWallsOfAnyShapeAndForSpringsOfAnyReach) {
  std::vector<StencilSpring> wide = someStencil();
  // Longer than the registers are wide, from the pleura, and more rows than some walls have.
  wide.insert(wide.end(), {{Layer::outer, Layer::outer, 0, 19, 0.2}, {Layer::outer, Layer::inner, 3, -18, 0.1}, {Layer::inner, Layer::inner, 1, -1, 0.3},
                           {Layer::inner, Layer::outer, -4, 2, 0.2}, {Layer::outer, Layer::inner, 9, 0, 0.1}});
  for (const auto& [rows, columns] : {std::pair{1, 40}, {30, 1}, {3, 3}, {7, 16}, {12, 17}, {26, 64}}) {
    const System system = crookedGrid(rows, columns, 0);
    const auto term = makeLatticeTerm("lattice", system, wide);
    const NodeVectors x = perturbed(system, 2, 5);
    NodeVectors exact(x.size()), rough(x.size());
    double largest = 0, largestRough = 0;
    const double energy = term->evaluate(x, exact, largest);
    EXPECT_NEAR(term->evaluateRoughly(x, rough, largestRough), energy, 1e-5 * energy);
    EXPECT_NEAR(largestRough, largest, 1e-5 * largest);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT(distance(rough[i], exact[i]), 1e-5 * largest) << rows << " x " << columns << ", " << i;
  }
}

TEST(LatticeTerm, RoughForcesAreTheExactOnesWhereASpringHasNoLength) {
  const System system = crookedGrid(5, 6, 0);
  const auto term = makeLatticeTerm("lattice", system, someStencil());
  NodeVectors x = perturbed(system, 1, 3), exact(x.size()), rough(x.size());
  x.set(7, x[8]);
  double largest = 0;
  const double energy = term->evaluate(x, exact, largest);
  EXPECT_EQ(term->evaluateRoughly(x, rough, largest), energy);
  EXPECT_EQ(rough.x, exact.x);
  EXPECT_EQ(rough.y, exact.y);
  EXPECT_EQ(rough.z, exact.z);
}

TEST(LatticeTerm, StaysFiniteWhenPointsCoincide) {
  const System system = crookedGrid(4, 4, 0);
  const auto term = makeLatticeTerm("all", system, someStencil());
  NodeVectors x = system.rest;
  for (std::size_t i = 0; i < x.size(); ++i) x.set(i, {1, 2, 3});
  NodeVectors gradient(x.size());
  double largest = 0;
  EXPECT_TRUE(std::isfinite(term->evaluate(x, gradient, largest)));
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_TRUE(isFinite(gradient[i]));
  EXPECT_GT(largest, 0);
}

TEST(LatticeTerm, ASpringWithoutCompressionPullsAndDoesNotPush) {
  const System system = crookedGrid(1, 2, 0);
  const auto thread = makeLatticeTerm("thread", system, {{Layer::outer, Layer::outer, 0, 1, 0.5, 0}});
  NodeVectors x = system.rest;
  x.x[1] += 3;
  EXPECT_GT(thread->energy(x), 1);
  x.x[1] -= 6;
  EXPECT_EQ(thread->energy(x), 0);
}

TEST(Drive, IsLinearBetweenItsFrames) {
  Drive drive;
  drive.frames = {{{0, 0, 0}}, {{1, 0, 0}}, {{1, 4, 0}}};
  NodeVectors x(3);
  drive.apply(0.75, 2, x);
  EXPECT_LT(distance(x[2], {1, 2, 0}), 1e-12);
  drive.apply(1, 2, x);
  EXPECT_LT(distance(x[2], {1, 4, 0}), 1e-12);
}
