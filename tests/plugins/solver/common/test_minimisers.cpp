// The minimisers alone, on walls that are hard.
#include "plugins/solver/common/lbfgs.h"
#include "plugins/solver/common/newton.h"

#include "kernel/physics/springs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace pectora;

namespace {

// A wall of n x n points 8 mm apart and 20 mm thick, each pleura point tied to an anchor 6 mm behind it.
System wall(int n) {
  System system;
  system.rows = system.columns = n;
  const std::size_t layer = std::size_t(n) * n;
  system.freeNodes = 2 * layer;
  system.rest = NodeVectors(3 * layer);
  std::vector<NodeSpring> ties;
  for (std::size_t i = 0; i < 3 * layer; ++i) {
    const std::size_t point = i % layer;
    system.rest.set(i, {8.0 * double(point % n), i < layer ? -20.0 : i < 2 * layer ? 0.0 : 6.0, 8.0 * double(point / n)});
    if (i >= 2 * layer) ties.push_back({layer + point, i, 0.6});
  }
  system.mass.assign(system.freeNodes, 1e-3);
  std::vector<StencilSpring> stencil{{Layer::outer, Layer::outer, 1, 0, 0.3}, {Layer::outer, Layer::outer, 0, 1, 0.3},
                                     {Layer::outer, Layer::outer, 1, 1, 0.1}, {Layer::outer, Layer::outer, -1, 1, 0.1}};
  for (int r = -2; r <= 2; ++r)
    for (int c = -2; c <= 2; ++c) stencil.push_back({Layer::outer, Layer::inner, r, c, 0.02});
  system.terms.push_back(makeLatticeTerm("lattice", system, stencil));
  system.terms.push_back(makeSpringTerm("ties", system, ties));
  return system;
}

std::vector<std::unique_ptr<Minimiser>> minimisers(const System& system) {
  std::vector<std::unique_ptr<Minimiser>> all;
  all.push_back(std::make_unique<Newton>(system));
  all.push_back(std::make_unique<Lbfgs>(makeBlockJacobi(system), 5));
  return all;
}

struct Result {
  Outcome outcome;
  Evaluation end;
  int iterations = 0;
};

Result minimise(Minimiser& minimiser, const System& system, NodeVectors& x, double tolerance, int most) {
  Result result;
  result.outcome = minimiser.minimise(Objective(system), x, result.end, {tolerance, most}, result.iterations, {});
  return result;
}

bool isFinite(const NodeVectors& x) {
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!isFinite(x[i])) return false;
  return true;
}

}  // namespace

TEST(Minimisers, ReachRestFromPointsThatCoincide) {
  const System system = wall(9);
  for (const auto& minimiser : minimisers(system)) {
    NodeVectors x = system.rest;
    for (std::size_t i = 0; i < system.freeNodes; ++i) x.set(i, {32, -10, 32});
    const Result result = minimise(*minimiser, system, x, 1e-6, 5000);
    EXPECT_EQ(result.outcome, Outcome::converged) << result.end.relativeResidual();
    EXPECT_TRUE(isFinite(x));
  }
}

TEST(Minimisers, ReachRestFromAWallThatCollapsedToAPlane) {
  const System system = wall(9);
  for (const auto& minimiser : minimisers(system)) {
    NodeVectors x = system.rest;
    for (std::size_t i = 0; i < system.freeNodes; ++i) x.y[i] = 0;
    const Result result = minimise(*minimiser, system, x, 1e-6, 5000);
    EXPECT_EQ(result.outcome, Outcome::converged) << result.end.relativeResidual();
    EXPECT_TRUE(isFinite(x));
  }
}

TEST(Minimisers, ComeToRestFromARandomStart) {
  const System system = wall(9);
  for (const auto& minimiser : minimisers(system)) {
    NodeVectors x = system.rest;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> jitter(-30, 30);
    for (std::size_t i = 0; i < system.freeNodes; ++i) x.add(i, {jitter(random), jitter(random), jitter(random)});
    const Result result = minimise(*minimiser, system, x, 1e-6, 5000);
    EXPECT_EQ(result.outcome, Outcome::converged) << result.end.relativeResidual();
    EXPECT_TRUE(isFinite(x));
  }
}

TEST(Minimisers, NeverRaiseTheEnergy) {
  const System system = wall(9);
  for (const auto& minimiser : minimisers(system)) {
    NodeVectors x = system.rest;
    for (std::size_t i = system.freeNodes; i < x.size(); ++i) x.y[i] -= 25;
    std::vector<double> history;
    Watch watch;
    watch.iteration = [&](const Evaluation& e) { history.push_back(e.value); };
    Evaluation end;
    int iterations = 0;
    EXPECT_EQ(minimiser->minimise(Objective(system), x, end, {1e-8, 5000}, iterations, watch), Outcome::converged);
    // Up to rounding of the sum.
    for (std::size_t n = 1; n < history.size(); ++n) EXPECT_LE(history[n], history[n - 1] * (1 + 1e-12));
  }
}

TEST(Minimisers, SayThatAStartWithoutNumbersDiverges) {
  const System system = wall(5);
  for (const auto& minimiser : minimisers(system)) {
    NodeVectors x = system.rest;
    x.x[7] = NAN;
    EXPECT_EQ(minimise(*minimiser, system, x, 1e-6, 100).outcome, Outcome::diverged);
  }
}

TEST(Newton, ConvergesFasterThanLinearlyAtTheEnd) {
  const System system = wall(9);
  Newton newton(system);
  NodeVectors x = system.rest;
  for (std::size_t i = system.freeNodes; i < x.size(); ++i)
    x.y[i] -= 3 * std::exp(-(std::pow(x.x[i] - 32, 2) + std::pow(x.z[i] - 32, 2)) / 400);
  const Result result = minimise(newton, system, x, 1e-10, 100);
  EXPECT_EQ(result.outcome, Outcome::converged);
  EXPECT_LE(result.iterations, 20);
}

TEST(Lbfgs, NeedsNoHessian) {
  // A term that offers none: a constant force on one skin point.
  struct Pull final : Term {
    std::string name() const override { return "pull"; }
    double energy(const NodeVectors& x) const override { return 0.1 * x.y[40]; }
    double evaluate(const NodeVectors& x, NodeVectors& gradient, double&) const override {
      gradient.y[40] += 0.1;
      return energy(x);
    }
    void addStiffnessBound(std::vector<double>&) const override {}
  };
  System system = wall(9);
  system.terms.push_back(std::make_unique<Pull>());
  EXPECT_EQ(makeHessian(system), nullptr);
  Lbfgs lbfgs(makeBlockJacobi(system), 5);
  NodeVectors x = system.rest;
  EXPECT_EQ(minimise(lbfgs, system, x, 1e-6, 5000).outcome, Outcome::converged);
  EXPECT_LT(x.y[40], -20.1);
}
