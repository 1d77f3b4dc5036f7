#include "kernel/value/plan.h"

#include <gtest/gtest.h>

#include <numbers>

using namespace pectora;

namespace {

// A bowed curve of eight control points from a to d with b and c near its ends' tangents.
Curve piece(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  Curve curve{3, clampedKnots(8, 3), {}};
  for (int i = 0; i < 8; ++i) {
    const double t = i / 7.0, s = 1 - t;
    curve.controls.push_back(a * (s * s * s) + b * (3 * s * s * t) + c * (3 * s * t * t) + d * (t * t * t));
  }
  return curve;
}

// Cartilage 7 sags from the rib to the sternum at the midline; cartilage 8 joins it half way.
RibCage smallCage() {
  RibCage cage;
  cage.anatomy = std::make_shared<Anatomy>();
  cage.cartilages.push_back({Side::left, 7, piece({80, -90, -40}, {60, -95, -60}, {30, -85, -20}, {15, -80, 0}), 0, 0});
  cage.cartilages.push_back({Side::left, 8, piece({95, -85, -60}, {80, -90, -70}, {60, -90, -50}, cage.cartilages[0].curve.at(0.5)), 7, 0.5});
  return cage;
}

RigidMotion forward(double mm) { return {{}, {1, 0, 0}, 0, {0, -mm, 0}}; }

}  // namespace

TEST(RigidMotion, TurnsAboutItsPivotByTheRightHand) {
  const RigidMotion turn{{0, 0, 100}, {1, 0, 0}, std::numbers::pi / 2, {}};
  EXPECT_LT(distance(turn({5, 1, 100}), {5, 0, 101}), 1e-12);
  EXPECT_LT(distance(turn({5, 0, 100}), {5, 0, 100}), 1e-12);
}

TEST(FollowSternum, LeavesCartilagesAtRestWhenNothingMoves) {
  const RibCage cage = smallCage();
  const auto moved = followSternum(cage, {});
  for (std::size_t i = 0; i < moved.size(); ++i) {
    for (int j = 0; j < 8; ++j) EXPECT_LT(distance(moved[i].curve.controls[j], cage.cartilages[i].curve.controls[j]), 1e-9);
    EXPECT_NEAR(moved[i].strain, 0, 1e-12);
  }
}

TEST(FollowSternum, KeepsTheRibsEndAndItsTangentAndMovesTheOther) {
  const RibCage cage = smallCage();
  const auto moved = followSternum(cage, forward(10));
  const Curve& rest = cage.cartilages[0].curve;
  EXPECT_LT(distance(moved[0].curve.at(0), rest.at(0)), 1e-12);
  EXPECT_NEAR(dot(normalized(moved[0].curve.derivative(0)), normalized(rest.derivative(0))), 1, 1e-12);
  EXPECT_LT(distance(moved[0].curve.at(1), rest.at(1) + Vec3{0, -10, 0}), 1e-12);
}

TEST(FollowSternum, KeepsTheArcLengthWhereTheBowCan) {
  const RibCage cage = smallCage();
  const auto moved = followSternum(cage, {{}, {1, 0, 0}, 0, {-4, 0, 0}});  // away from the rib
  EXPECT_NEAR(moved[0].curve.length(), cage.cartilages[0].curve.length(), 1e-6);
  EXPECT_NEAR(moved[0].strain, 0, 1e-7);
}

TEST(FollowSternum, ReportsAsStrainWhatCannotBeKept) {
  const RibCage cage = smallCage();
  const auto moved = followSternum(cage, forward(120));
  const double chord = distance(moved[0].curve.at(0), moved[0].curve.at(1));
  EXPECT_GT(moved[0].strain, chord / cage.cartilages[0].curve.length() - 1 - 1e-9);
  EXPECT_NEAR(moved[0].strain, moved[0].curve.length() / cage.cartilages[0].curve.length() - 1, 1e-12);
}

TEST(FollowSternum, CarriesTheArchAlongWithTheCartilageThatItJoins) {
  const RibCage cage = smallCage();
  const auto moved = followSternum(cage, forward(10));
  EXPECT_LT(distance(moved[1].curve.at(1), moved[0].curve.at(0.5)), 1e-9);
}

TEST(Plan, MovesAnchorsSmoothlyFromRestToTheEnd) {
  auto cage = std::make_shared<RibCage>(smallCage());
  Plan plan;
  plan.cage = cage;
  plan.motion = forward(10);
  for (int f = 0; f <= 10; ++f) plan.frames.push_back(followSternum(*cage, plan.motion.part(f / 10.0)));
  const Anchor onCartilage{0, BodyKind::cartilage, 0, 1.0, cage->cartilages[0].curve.at(1)};
  const Anchor onSternum{0, BodyKind::sternum, 0, 0, {1, -80, 3}};
  const Anchor onRib{0, BodyKind::rib, 0, 0.3, {90, 0, 0}};
  for (double t : {0.0, 0.25, 0.5, 1.0}) {
    EXPECT_LT(distance(plan.moved(onCartilage, t), onCartilage.rest + Vec3{0, -10 * t, 0}), 1e-9);
    EXPECT_LT(distance(plan.moved(onSternum, t), onSternum.rest + Vec3{0, -10 * t, 0}), 1e-9);
    EXPECT_EQ(plan.moved(onRib, t), onRib.rest);
  }
}

TEST(FollowSternum, NeverArchesACartilageThatIsTooLongNow) {
  const RibCage cage = smallCage();
  const auto moved = followSternum(cage, {{}, {1, 0, 0}, 0, {12, 0, 0}});  // towards the rib
  EXPECT_LT(moved[0].strain, 0);
  for (double u = 0; u <= 1; u += 0.05) EXPECT_GT(moved[0].curve.at(u).y, -101);
}
