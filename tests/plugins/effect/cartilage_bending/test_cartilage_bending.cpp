// The chest's stiffness, and how it shares the lift with the bar.
#include "plugins/effect/cartilage_bending/chest.h"

#include "tests/plugins/solver/wall.h"

#include <numbers>

using namespace pectora;

namespace {

// A wall whose sternum is held by four straight cartilages 60 mm long that go with it by half of the lift.
Wall chest(double lift) {
  Wall wall(lift);
  auto cage = std::make_shared<RibCage>(*wall.scene->cage);
  for (int i = 0; i < 4; ++i) {
    Cartilage cartilage;
    cartilage.curve.controls = {{0, 0, 0}, {20, 0, 0}, {40, 0, 0}, {60, 0, 0}};
    cartilage.curve.knots = clampedKnots(4, 3);
    cage->cartilages.push_back(cartilage);
  }
  wall.scene->cage = wall.plan->cage = cage;
  wall.plan->frames.clear();
  for (const double t : {0.0, 1.0}) {
    std::vector<MovedCartilage> frame;
    for (const Cartilage& c : cage->cartilages) {
      frame.push_back({c.curve, 0});
      frame.back().curve.controls.back() += Vec3{0, -0.5 * t * lift, 0};
    }
    wall.plan->frames.push_back(frame);
  }
  return wall;
}

const double kMoment = secondMomentOfEllipse(14, 10);

}  // namespace

TEST(CartilageBending, OfAnEllipseHasTheKnownSecondMoment) { EXPECT_NEAR(kMoment, std::numbers::pi / 4 * 7 * 125, 1e-9); }

TEST(CartilageBending, CountsGuidedBeamsInSeriesWithTheirRibs) {
  const double beam = 12 * 25 * kMoment / (60. * 60 * 60);
  EXPECT_NEAR(chestResistance(*chest(20).plan, 25, kMoment, 1e12), 4 * 10 * 10 * beam, 1e-9);
  EXPECT_NEAR(chestResistance(*chest(20).plan, 25, kMoment, 2), 4 * 10 * 10 / (1 / beam + 1 / 2.0), 1e-9);
  EXPECT_EQ(chestResistance(*chest(0).plan, 25, kMoment, 2), 0);
}

TEST(CartilageBending, TellsTheForceOnTheBar) {
  Wall wall = chest(20);
  wall.scene->effects.push_back(call("effect.cartilage_bending"));
  const auto motion = Solve("solver.newton")(wall, {});
  EXPECT_NEAR(motion->barForce(), chestResistance(*wall.plan, 25, kMoment, 5) / 20, 1e-9);
  EXPECT_EQ(motion->lift, 20);
}
