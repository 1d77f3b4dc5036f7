// The bar that pushes the inner wall forwards.
#include "plugins/effect/bar_contact/bar_front.h"

#include "tests/plugins/solver/wall.h"

using namespace pectora;

namespace {

// A straight bar across the wall at height z, whose front ends up at y.
void layBar(Plan& plan, double z, double y) {
  plan.bar.centerline.clear();
  for (int i = 0; i <= 80; ++i) plan.bar.centerline.push_back({-64 + 3.2 * i, y + 0.5 * plan.bar.height, z});
}

}  // namespace

TEST(BarContact, FindsTheBarsFrontUnderItsMiddlePartAlone) {
  Plan plan;
  plan.lift = 20;
  layBar(plan, 50, -7);
  const std::vector<Vec3> points{{64, 0, 50}, {64, 0, 58}, {64, 0, 70}, {-40, 0, 50}};
  const std::vector<Vec3> end = barFront(plan, 1, points, 4), middle = barFront(plan, 0.5, points, 4);
  EXPECT_NEAR(end[0].y, -7, 1e-12);
  EXPECT_NEAR(middle[0].y, 3, 1e-12);   // half of the lift is still to come
  EXPECT_NEAR(end[1].y, -7, 1e-12);     // within half the width and the margin
  EXPECT_GT(end[2].y, 1000);            // below the bar
  EXPECT_GT(end[3].y, 1000);            // beside its middle part
}

TEST(BarContact, BringsTheInnerWallInFrontOfTheBar) {
  // A bar that ends 6 mm in front of where the middle's inner wall would be.
  Wall wall(15);
  layBar(*wall.plan, 64, -21);
  const auto without = Solve("solver.newton")(wall, {});
  wall.scene->effects.push_back(call("effect.bar_contact", {{"stiffness", 50.0}}));
  const auto with = Solve("solver.newton")(wall, {});
  const int middle = wall.scene->index(8, 8);
  EXPECT_GT(without->inner[middle].y, -18);
  // Springs of some 1 N/mm pushed by 6 mm give way in 50 N/mm by 0.12 mm.
  EXPECT_LT(with->inner[middle].y, -21 + 0.15);
  EXPECT_EQ(with->status, SolveStatus::converged);
}
