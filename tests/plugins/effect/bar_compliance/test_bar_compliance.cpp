// A bar that gives way.
#include "tests/plugins/solver/wall.h"

using namespace pectora;

namespace {

// A wall on one cartilage of 40 mm that goes all the way with the sternum.
Wall heldWall(double lift) {
  Wall wall(lift);
  auto cage = std::make_shared<RibCage>(*wall.scene->cage);
  Cartilage cartilage;
  cartilage.curve.controls = {{0, 0, 0}, {10, 0, 0}, {30, 0, 0}, {40, 0, 0}};
  cartilage.curve.knots = clampedKnots(4, 3);
  cage->cartilages = {cartilage};
  wall.scene->cage = wall.plan->cage = cage;
  MovedCartilage moved{cartilage.curve, 0};
  moved.curve.controls.back() += Vec3{0, -lift, 0};
  wall.plan->frames = {{{cartilage.curve, 0}}, {moved}};
  return wall;
}

}  // namespace

TEST(BarCompliance, SharesTheLiftWithTheChestAsSpringsInSeries) {
  Wall wall = heldWall(20);
  wall.scene->effects.push_back(call("effect.cartilage_bending"));
  const double rigid = Solve("solver.newton")(wall, {})->barForce(), chest = rigid / 20;
  wall.scene->effects.push_back(call("effect.bar_compliance"));
  const auto motion = Solve("solver.newton")(wall, {});
  // k = 48 E I / L^3 = 39.5 N/mm for the usual bar over 220 mm.
  const double bar = 48 * 193e3 * 12.7 * 3.5 * 3.5 * 3.5 / 12 / (220. * 220 * 220);
  EXPECT_NEAR(bar, 39.5, 0.1);
  EXPECT_NEAR(motion->lift, 20 * bar / (bar + chest), 1e-9);
  EXPECT_NEAR(motion->barForce(), chest * motion->lift, 1e-9);
  EXPECT_NEAR(motion->barForce(), bar * (20 - motion->lift), 1e-9);
  // The skin follows what the sternum does, not what was planned.
  Wall less = heldWall(motion->lift);
  EXPECT_LT(largestDifference(Solve("solver.newton")(less, {{"tolerance", 1e-8}})->outer, Solve("solver.newton")(wall, {{"tolerance", 1e-8}})->outer), 1e-3);
}

TEST(BarCompliance, SharesTheWayOfTwoBarsByTheirEnergies) {
  // Two equal bars at the ends of one plan: the chest's resistance against b (L1^2 + L2^2).
  Wall wall = heldWall(20);
  wall.scene->effects.push_back(call("effect.cartilage_bending"));
  const double chest = Solve("solver.newton")(wall, {})->barForce() / 20;
  wall.plan->bars.push_back({.lift = 10});
  wall.scene->effects.push_back(call("effect.bar_compliance"));
  const auto motion = Solve("solver.newton")(wall, {});
  const double bar = 48 * 193e3 * 12.7 * 3.5 * 3.5 * 3.5 / 12 / (220. * 220 * 220), part = bar * 500 / (bar * 500 + chest * 400);
  EXPECT_NEAR(motion->lift, 20 * part, 1e-9);
  ASSERT_EQ(motion->barForces.size(), 2u);
  EXPECT_NEAR(motion->barForces[0], bar * (1 - part) * 20, 1e-9);
  EXPECT_NEAR(motion->barForces[1], bar * (1 - part) * 10, 1e-9);
}

TEST(BarCompliance, DropsOutWhereNothingPushesBack) {
  Registry registry({PECTORA_PLUGINS});
  Wall wall = heldWall(20);
  wall.scene->effects.push_back(call("effect.bar_compliance"));
  EXPECT_FALSE(compile(*wall.scene, registry).effects.back().isActive);
}
