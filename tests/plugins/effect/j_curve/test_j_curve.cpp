// Skin that stiffens: its law, its derivatives, and what it does to the wall.
#include "plugins/effect/j_curve/fung.h"

#include "tests/kernel/physics/derivatives.h"
#include "tests/plugins/solver/wall.h"

using namespace pectora;

namespace {

constexpr double kStiffness = 0.3, kLength = 8, kExponent = 11, kMost = 20;

Vec3 stretched(double strain) { return Vec3{2, -1, 2} * ((1 + strain) * kLength / 3); }

}  // namespace

TEST(JCurve, WithItsLinearSpringHasTheStiffnessOfFungsLaw) {
  const auto law = makeFungLaw({{kStiffness, kLength}}, kExponent, kMost);
  const auto tension = [&](double strain) { return norm(law->pull(0, stretched(strain)).force) + kStiffness * kLength * strain; };
  // k l0 (exp(b e) - 1) / b up to the strain at which the stiffness is the greatest, and straight on from there.
  const double last = std::log(kMost) / kExponent;
  for (const double strain : {0.01, 0.1, 0.9 * last}) EXPECT_NEAR(tension(strain), kStiffness * kLength * std::expm1(kExponent * strain) / kExponent, 1e-12);
  EXPECT_NEAR(tension(last + 0.5) - tension(last + 0.4), kMost * kStiffness * kLength * 0.1, 1e-9);
  EXPECT_EQ(norm(law->pull(0, stretched(-0.2)).force), 0);
}

TEST(JCurve, HasTheDerivativesOfItsEnergy) {
  System system;
  system.freeNodes = 4;
  system.rest = noise(6, 10, 3);
  std::vector<NodePair> pairs{{0, 1}, {1, 2}, {2, 3}, {0, 5}, {3, 4}};
  system.terms.push_back(makePairTerm("skin", system, pairs, makeFungLaw({{0.3, 4}, {0.2, 5}, {0.1, 30}, {0.2, 6}, {0.5, 3}}, 3, 50), true));
  const auto hessian = makeHessian(system);
  const NodeVectors x = noise(6, 12, 4), v = noise(6, 1, 5), g = gradientAt(system, x);
  NodeVectors still = v;
  for (std::size_t i = 4; i < 6; ++i) still.set(i, {});
  const double h = 1e-5;
  // Central differences are right to h^2 times the third derivative, some 1e-8 of these values.
  EXPECT_NEAR((system.energy(sum(x, h, still)) - system.energy(sum(x, -h, still))) / (2 * h), inner(g, still), 1e-6 * std::abs(inner(g, still)));
  hessian->linearise(x, false);
  const NodeVectors hv = product(*hessian, still), up = gradientAt(system, sum(x, h, still)), down = gradientAt(system, sum(x, -h, still));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(norm(hv[i] - (up[i] - down[i]) / (2 * h)), 1e-5 * (1 + norm(hv[i])));
  const NodeVectors blocks = productOfBlocks(*hessian, still);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(norm(hv[i] - blocks[i]), 1e-10 * (1 + norm(hv[i])));
}

TEST(JCurve, StretchesTheSkinLessAndGivesTheSameByAnySolver) {
  const auto longest = [](const Motion& m) {
    double most = 0;
    for (int r = 0; r < 17; ++r)
      for (int c = 0; c < 16; ++c)
        most = std::max(most, distance(m.outer[m.scene->index(r, c)], m.outer[m.scene->index(r, c + 1)]) / 8 - 1);
    return most;
  };
  const Wall plain(25);
  Wall stiffening(25);
  stiffening.scene->effects.push_back(call("effect.j_curve", {{"youngs_modulus", 200.0}}));
  const auto with = Solve("solver.newton")(stiffening, {{"tolerance", 1e-7}});
  EXPECT_LT(longest(*with), 0.9 * longest(*Solve("solver.newton")(plain, {{"tolerance", 1e-7}})));
  for (const char* solver : {"solver.lbfgs", "solver.multigrid"})
    EXPECT_LT(largestDifference(Solve(solver)(stiffening, {{"tolerance", 1e-7}})->outer, with->outer), 1e-3) << solver;
}

TEST(JCurve, DropsOutWithoutAnExponent) {
  Registry registry({PECTORA_PLUGINS});
  Wall wall(10);
  wall.scene->effects.push_back(call("effect.j_curve", {{"exponent", 0.0}}));
  EXPECT_FALSE(compile(*wall.scene, registry).effects.back().isActive);
}
