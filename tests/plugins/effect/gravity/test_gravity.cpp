// Weight: its derivatives, a chain that hangs, and the shape without it.
#include "plugins/effect/gravity/weight.h"

#include "kernel/physics/springs.h"
#include "plugins/solver/common/newton.h"
#include "tests/kernel/physics/derivatives.h"
#include "tests/plugins/solver/wall.h"

using namespace pectora;

namespace {

// The wall, with its weight. A stiff one hangs through by little, so that the shape without weight can be found.
Wall heavyWall(double lift, Settings gravity, double stiffness = 1) {
  Wall wall(lift, stiffness);
  wall.scene->outerMass.assign(17 * 17, 2e-3);
  wall.scene->innerMass = wall.scene->outerMass;
  wall.scene->effects.push_back(call("effect.gravity", std::move(gravity)));
  return wall;
}

}  // namespace

TEST(Gravity, OfAHangingChainEachSpringBearsTheWeightBelow) {
  // T_i = sum of the weights below spring i; the top end is held.
  System system;
  constexpr int kLinks = 12;
  system.freeNodes = kLinks;
  system.rest = NodeVectors(kLinks + 1);
  system.mass.resize(kLinks);
  std::vector<NodeSpring> springs;
  for (int i = 0; i < kLinks; ++i) {
    system.rest.set(i, {0, 0, -10.0 * (i + 1)});
    system.mass[i] = 1e-3 * (1 + i % 3);
    springs.push_back({std::size_t(i == 0 ? kLinks : i - 1), std::size_t(i), 0.05 + 0.01 * i});
  }
  const auto stiffness = [&](int i) { return springs[i].stiffnessNPerMm; };
  system.terms.push_back(makeSpringTerm("chain", system, springs));
  system.terms.push_back(makeWeightTerm(system, {0, 0, -9.81}));
  NodeVectors x = system.rest;
  Objective objective(system);
  Evaluation end;
  int iterations = 0;
  ASSERT_EQ(Newton(system).minimise(objective, x, end, {1e-12, 100}, iterations, {}), Outcome::converged);
  double below = 0;
  for (int i = kLinks; i-- > 0;) {
    below += system.mass[i] * 9.81;
    const Vec3 upper = i == 0 ? x[kLinks] : x[i - 1];
    EXPECT_NEAR(stiffness(i) * (distance(upper, x[i]) - 10), below, 1e-10);
  }
}

TEST(Gravity, IsTheGradientOfItsEnergy) {
  System system;
  system.freeNodes = 3;
  system.rest = noise(4, 20, 1);
  system.mass = {1e-3, 2e-3, 5e-3};
  system.terms.push_back(makeWeightTerm(system, {1, 2, -9.81}));
  const NodeVectors x = noise(4, 30, 2), gradient = gradientAt(system, x);
  // Linear in the positions: differences are exact.
  for (std::size_t i = 0; i < 3; ++i)
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
      NodeVectors moved = x;
      moved.add(i, axis);
      EXPECT_NEAR(system.energy(moved) - system.energy(x), dot(gradient[i], axis), 1e-12);
    }
}

TEST(Gravity, InThePostureOfTheCtLeavesTheChestAsTheCtShowsIt) {
  for (const double stiffness : {1.0, 20.0}) {
    const Wall wall = heavyWall(0, {{"ct_posture", std::string("supine")}, {"posture", std::string("supine")}}, stiffness);
    const auto motion = Solve("solver.newton")(wall, {{"tolerance", 1e-5}});
    // The shape without load is found to 0.02 mm; where there is none, the loads cancel.
    EXPECT_LT(largestDifference(motion->outer, wall.scene->outer), 0.03) << stiffness;
  }
}

TEST(Gravity, OnAStiffWallGoesBackToTheShapeWithoutWeight) {
  Solve solve("solver.newton");
  const Wall lies = heavyWall(0, {{"ct_posture", std::string("supine")}, {"posture", std::string("none")}}, 5);
  const auto free = solve(lies, {{"tolerance", 1e-8}});
  // Without the weight that drew it backwards (+y) the skin comes forwards, and the weight put on that shape draws it back.
  Wall again = heavyWall(0, {{"ct_posture", std::string("none")}, {"posture", std::string("supine")}}, 5);
  again.scene->outer = free->outer;
  again.scene->inner = free->inner;
  const auto loaded = solve(again, {{"tolerance", 1e-8}});
  const int middle = lies.scene->index(8, 8);
  EXPECT_LT(free->outer[middle].y, lies.scene->outer[middle].y - 0.05);
  // Attachments keep the anchors where the CT has them, so that the way back is a little off.
  EXPECT_LT(largestDifference(loaded->outer, lies.scene->outer), 0.1 * largestDifference(free->outer, lies.scene->outer) + 0.03);
}

TEST(Gravity, DrawsTheSkinOfAStandingPatientDown) {
  const Wall wall = heavyWall(0, {{"ct_posture", std::string("supine")}, {"posture", std::string("upright")}});
  const auto motion = Solve("solver.newton")(wall, {});
  const int middle = wall.scene->index(8, 8);
  EXPECT_LT(motion->outer[middle].z, wall.scene->outer[middle].z - 0.1);
}

TEST(Gravity, OfNoStrengthDropsOut) {
  Registry registry({PECTORA_PLUGINS});
  EXPECT_FALSE(compile(*heavyWall(0, {{"acceleration", 0.0}}).scene, registry).effects.back().isActive);
}
