// The bar that pushes the inner wall forwards.
#include "plugins/effect/bar_contact/bar_front.h"

#include "tests/plugins/solver/wall.h"

using namespace pectora;

namespace {

// A straight bar across the wall that passes its middle at height z and rises by `slope`; its front ends up at y.
Bar straightBar(double z, double y, double lift, double slope = 0) {
  Bar bar{.lift = lift};
  bar.up = normalized({-slope, 0, 1});
  for (int i = 0; i <= 80; ++i) bar.centerline.push_back({-64 + 3.2 * i, y + 0.5 * bar.height, z + slope * (-128 + 3.2 * i)});
  return bar;
}

}  // namespace

TEST(BarContact, FindsTheBarsFrontUnderItsMiddlePartAlone) {
  Plan plan;
  plan.bars = {straightBar(50, -7, 20)};
  const std::vector<Vec3> points{{64, 0, 50}, {64, 0, 58}, {64, 0, 70}, {-40, 0, 50}};
  const std::vector<Vec3> end = barFront(plan, 1, points, 4), middle = barFront(plan, 0.5, points, 4);
  EXPECT_NEAR(end[0].y, -7, 1e-12);
  EXPECT_NEAR(middle[0].y, 3, 1e-12);   // half of the lift is still to come
  EXPECT_NEAR(end[1].y, -7, 1e-12);     // within half the width and the margin
  EXPECT_GT(end[2].y, 1000);            // below the bar
  EXPECT_GT(end[3].y, 1000);            // beside its middle part
}

TEST(BarContact, FollowsABarThatLiesObliquely) {
  Plan plan;
  plan.bars = {straightBar(50, -7, 20, 0.5)};
  // 40 mm to the left it runs 20 mm higher, and its half width and margin of 10.35 mm reach 11.6 mm along z.
  const std::vector<Vec3> front = barFront(plan, 1, {{104, 0, 70}, {104, 0, 81}, {104, 0, 82}, {104, 0, 50}}, 4);
  EXPECT_NEAR(front[0].y, -7, 1e-12);
  EXPECT_NEAR(front[1].y, -7, 1e-12);
  EXPECT_GT(front[2].y, 1000);
  EXPECT_GT(front[3].y, 1000);
}

TEST(BarContact, TakesOfTwoBarsTheOneThatIsFartherForward) {
  Plan plan;
  plan.bars = {straightBar(50, -7, 20), straightBar(60, -12, 10)};
  const std::vector<Vec3> points{{64, 0, 48}, {64, 0, 55}, {64, 0, 64}};
  const std::vector<Vec3> end = barFront(plan, 1, points, 4), begin = barFront(plan, 0, points, 4);
  EXPECT_NEAR(end[0].y, -7, 1e-12);
  EXPECT_NEAR(end[1].y, -12, 1e-12);
  EXPECT_NEAR(end[2].y, -12, 1e-12);
  EXPECT_NEAR(begin[1].y, -2, 1e-12);   // each comes by its own lift
}

TEST(BarContact, BringsTheInnerWallInFrontOfTheBar) {
  // A bar that ends 6 mm in front of where the middle's inner wall would be.
  Wall wall(15);
  wall.plan->bars = {straightBar(64, -21, 15)};
  const auto without = Solve("solver.newton")(wall, {});
  wall.scene->effects.push_back(call("effect.bar_contact", {{"stiffness", 50.0}}));
  const auto with = Solve("solver.newton")(wall, {});
  const int middle = wall.scene->index(8, 8);
  EXPECT_GT(without->inner[middle].y, -18);
  // Blocks of 0.64 + 0.50 + 0.50 N/mm pushed by 6 mm give way in 50 N/mm by 0.2 mm; the wall before them adds little.
  EXPECT_NEAR(with->inner[middle].y, -21 + 0.2, 0.05);
  EXPECT_EQ(with->status, SolveStatus::converged);
}
