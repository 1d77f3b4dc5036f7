#include "plugins/planner/nuss/bar.h"
#include "plugins/planner/nuss/motion.h"

#include "kernel/stage/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace pectora;

namespace {

Sternum plateSternum() {
  Sternum s;
  s.jugularNotch = {0, -90, -40};
  s.manubriosternalJoint = {0, -95, -86};
  s.xiphisternalJoint = {0, -75, -180};
  s.deepest = {0, -72, -160};
  for (double z = -180; z <= -40; z += 5) s.contours.push_back({{-16, -80, z}, {16, -80, z}, {16, -70, z}, {-16, -70, z}});
  for (int rib = 2; rib <= 7; ++rib)
    for (Side side : {Side::right, Side::left}) s.notches.push_back({side, rib, {side == Side::right ? -18.0 : 18.0, -80, -86.0 - 16 * (rib - 2)}});
  return s;
}

// Half an ellipse from the back to the front on either side.
RibCage ribRing() {
  RibCage cage;
  auto anatomy = std::make_shared<Anatomy>();
  anatomy->sternum = plateSternum();
  cage.anatomy = anatomy;
  for (const double sign : {-1.0, 1.0}) {
    Curve curve;
    curve.knots = clampedKnots(4, 3);
    curve.controls = {{sign * 20, 60, -120}, {sign * 170, 60, -140}, {sign * 150, -130, -160}, {sign * 60, -105, -165}};
    cage.ribs.push_back({sign < 0 ? Side::right : Side::left, 5, curve, 0});
  }
  return cage;
}

}  // namespace

TEST(DeepestOfPit, LiesWhereTheSternumIsFarthestBehindTheWallAndNotWhereItIsMostPosterior) {
  // A sternum that runs forwards below z = -130 in a pit that is deepest at z = -155.
  Anatomy anatomy;
  Sternum& s = anatomy.sternum;
  s.manubriosternalJoint = {0, -90, -86};
  s.xiphisternalJoint = {0, -88, -180};
  for (double z = -180; z <= -40; z += 5) {
    const double y = z < -130 ? -80 - 0.2 * (-130 - z) : -80 - 0.1 * (z + 130);
    s.contours.push_back({{-16, y, z}, {4, y, z}, {16, y, z}, {16, y + 10, z}, {4, y + 10, z}, {-16, y + 10, z}});
    const double wall = -90 - 30 * std::exp(-(z + 155) * (z + 155) / 800);   // the most forward inner wall
    anatomy.metrics.push_back({.z = z, .transverse = 240, .sternumToVertebra = 20 - y - 40, .deepestInnerWall = -wall - 20});
  }
  s.deepest = {4, -80, -130};
  const Vec3 found = deepestOfPit(anatomy);
  EXPECT_NEAR(found.z, -155, 5.1);   // to a level
  EXPECT_NEAR(found.x, 4, 1e-9);
  EXPECT_NEAR(found.y, -80 - 0.2 * (-130 - found.z), 1e-9);
  anatomy.metrics.clear();
  EXPECT_EQ(deepestOfPit(anatomy).z, -130);
}

TEST(LiftRotation, BringsTheDeepestPointForwardByTheLift) {
  const Sternum s = plateSternum();
  for (const Pivot pivot : {Pivot::sternoclavicular, Pivot::manubrium})
    for (const double lift : {0.0, 1.0, 30.0, 50.0}) {
      const RigidMotion motion = liftRotation(s.deepest, lift, pivotPoint(s, s.deepest, pivot, 160));
      EXPECT_NEAR(s.deepest.y - motion(s.deepest).y, lift, 1e-9) << lift;
    }
}

TEST(LiftRotation, AboutTheSternoclavicularAxisHasTheMeasuredProfile) {
  // 38.6, 28.4 and 19.4 mm at 0, 4 and 8 cm cranial, SD about 6 mm (PMID 33742267).
  const Sternum s = plateSternum();
  const RigidMotion motion = liftRotation(s.deepest, 38.6, pivotPoint(s, s.deepest, Pivot::sternoclavicular, 160));
  const auto rise = [&](double cranial) {
    const Vec3 p = s.deepest + Vec3{0, 0, cranial};
    return p.y - motion(p).y;
  };
  EXPECT_NEAR(rise(40), 28.4, 2);
  EXPECT_NEAR(rise(80), 19.4, 2);
}

TEST(LiftRotation, AboutTheManubriumLeavesTheJointWhereItIs) {
  const Sternum s = plateSternum();
  const RigidMotion motion = liftRotation(s.deepest, 20, s.manubriosternalJoint);
  EXPECT_LT(distance(motion(s.manubriosternalJoint), s.manubriosternalJoint), 1e-12);
}

TEST(LiftRotation, RefusesWhatNoRotationCanReach) {
  const Sternum s = plateSternum();
  EXPECT_THROW(liftRotation(s.deepest, 200, s.manubriosternalJoint), Error);
  EXPECT_THROW(liftRotation({0, -80, -80}, 10, s.manubriosternalJoint), Error);
}

TEST(LiftBoth, BringsBothPointsForwardByTheirLifts) {
  const Sternum s = plateSternum();
  const Vec3 axis = pivotPoint(s, s.deepest, Pivot::sternoclavicular, 160);
  for (const Vec3 other : {Vec3{0, -80, -130}, Vec3{0, -78, -175}})
    for (const double first : {0.0, 15.0, 40.0})
      for (const double second : {0.0, 20.0, 45.0}) {
        if (std::abs(first - second) > 0.8 * distance(other, s.deepest)) continue;   // more than they can turn
        const RigidMotion motion = liftBoth({s.deepest, first}, {other, second}, axis, 12.7);
        EXPECT_NEAR(s.deepest.y - motion(s.deepest).y, first, 1e-9);
        EXPECT_NEAR(other.y - motion(other).y, second, 1e-9);
        // In the sagittal plane, and the axis keeps its height.
        EXPECT_EQ(motion(s.deepest).x, s.deepest.x);
        EXPECT_NEAR(motion(axis).z, axis.z, 1e-9);
      }
}

TEST(LiftBoth, ShiftsWithoutTurningByEqualLifts) {
  const RigidMotion motion = liftBoth({{0, -72, -160}, 25}, {{0, -80, -120}, 25}, {0, -95, 0}, 12.7);
  EXPECT_NEAR(motion.angle, 0, 1e-12);
  EXPECT_LT(distance(motion({3, 4, 5}), {3, -21, 5}), 1e-9);
}

TEST(LiftBoth, IsTheTurnAboutTheAxisWhereThatBringsBothLifts) {
  const Vec3 axis{0, -95, 0}, low{0, -72, -160}, high{0, -84, -110};
  const RigidMotion turn = liftRotation(low, 30, axis), both = liftBoth({low, 30}, {high, high.y - turn(high).y}, axis, 12.7);
  EXPECT_NEAR(both.angle, turn.angle, 1e-9);
  EXPECT_LT(norm(both.translation), 1e-9);
}

TEST(LiftBoth, RefusesBarsThatLieOnEachOtherAndLiftsTooFarApart) {
  const Vec3 axis{0, -95, 0}, low{0, -72, -160};
  EXPECT_THROW(liftBoth({low, 30}, {low + Vec3{0, 0, 5}, 20}, axis, 12.7), Error);
  EXPECT_THROW(liftBoth({low, 30}, {low, 30}, axis, 0.1), Error);
  EXPECT_THROW(liftBoth({low, 60}, {low + Vec3{0, 0, 20}, 0}, axis, 12.7), Error);   // 60 mm over 20
  EXPECT_THROW(liftBoth({low, 29}, {low + Vec3{0, 0, 30}, 0}, axis, 12.7), Error);   // 75 degrees
}

TEST(IntercostalSpace, LiesBelowTheLowestRibThatJoinsAboveTheBarOnThatSide) {
  const Sternum s = plateSternum();
  const Vec3 between{0, -80, -86 - 16 * 2.5}, level{0, 0, 1};
  for (const Side side : {Side::right, Side::left}) {
    EXPECT_EQ(intercostalSpace(s, side, between, level), 4);
    EXPECT_EQ(intercostalSpace(s, side, {}, level), 0);
  }
  // Notches 18 mm beside the middle: at 45 degrees the bar passes them 18 mm higher on the left and lower on the right.
  const Vec3 oblique = normalized({-1, 0, 1});
  EXPECT_EQ(intercostalSpace(s, Side::left, between, oblique), 3);
  EXPECT_EQ(intercostalSpace(s, Side::right, between, oblique), 5);
}

TEST(Bar, PassesBehindTheLiftedSternumAndEndsAtTheSides) {
  const RibCage cage = ribRing();
  const Sternum& s = cage.anatomy->sternum;
  const RigidMotion motion = liftRotation(s.deepest, 25, pivotPoint(s, s.deepest, Pivot::sternoclavicular, 160));
  const Bar bar = shapeBar(cage, s.deepest, 25, motion, 0, {});
  ASSERT_GE(bar.centerline.size(), 3u);
  const Vec3 middle = bar.centerline[bar.centerline.size() / 2];
  const double back = -70 - 25;  // of the plate, lifted
  EXPECT_NEAR(middle.x, 0, 2);
  EXPECT_GT(middle.y, back);     // behind it
  EXPECT_LT(middle.y, back + 12);
  EXPECT_LT(bar.centerline.front().x, -100);
  EXPECT_GT(bar.centerline.back().x, 100);
  for (const Vec3& p : bar.centerline) EXPECT_NEAR(p.z, middle.z, 1e-9);
}

TEST(Bar, LiesInThePlaneOfItsTiltWithTheLeftEndHigher) {
  const RibCage cage = ribRing();
  const Sternum& s = cage.anatomy->sternum;
  const RigidMotion motion = liftRotation(s.deepest, 25, pivotPoint(s, s.deepest, Pivot::sternoclavicular, 160));
  const Bar bar = shapeBar(cage, s.deepest, 25, motion, 4, {});
  const Vec3 lifted = motion(s.deepest);
  EXPECT_NEAR(bar.tiltDeg(), 4, 1e-9);
  for (const Vec3& p : bar.centerline) EXPECT_NEAR(p.z - lifted.z, (p.x - lifted.x) * std::tan(4 * std::numbers::pi / 180), 1e-9);
  EXPECT_GT(bar.centerline.back().z, bar.centerline.front().z + 14);
  EXPECT_LT(bar.centerline.front().x, -100);
  EXPECT_GT(bar.centerline.back().x, 100);
}
