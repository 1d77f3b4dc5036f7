#include "kernel/value/indices.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pectora;

namespace {

// A straight sternum 10 mm thick and upright, its back at y = -50 before a vertebra at 0, between ribs that reach to -80.
Anatomy uprightChest() {
  Anatomy anatomy;
  anatomy.sternum.manubriosternalJoint = {0, -55, 60};
  anatomy.sternum.xiphisternalJoint = {0, -55, 0};
  for (int z = -40; z <= 100; z += 5) {
    anatomy.sternum.contours.push_back({{-15, -50, double(z)}, {15, -50, double(z)}, {15, -60, double(z)}, {-15, -60, double(z)}});
    if (z >= 0 && z <= 60) anatomy.metrics.push_back({double(z), 240, 50, 80});
  }
  return anatomy;
}

}  // namespace

TEST(PlannedIndices, StayWhereNothingMoves) {
  const auto indices = plannedIndices(uprightChest(), {});
  ASSERT_TRUE(indices);
  EXPECT_DOUBLE_EQ(indices->after.haller(), 240.0 / 50);
  EXPECT_DOUBLE_EQ(indices->after.depression(), 30);
}

TEST(PlannedIndices, FollowAShiftExactly) {
  const auto indices = plannedIndices(uprightChest(), {{}, {1, 0, 0}, 0, {0, -20, 0}});
  ASSERT_TRUE(indices);
  EXPECT_NEAR(indices->before.haller(), 4.8, 1e-12);
  EXPECT_NEAR(indices->after.haller(), 240.0 / 70, 1e-12);
  EXPECT_NEAR(indices->after.correctionIndex(), 100 * 10.0 / 80, 1e-12);
  EXPECT_NEAR(indices->after.depression(), 10, 1e-12);
}

TEST(PlannedIndices, FollowARotationAboutAnAxisAbove) {
  // Turned by a about (y, z) = (-50, 100), the back is the line y = -50 - (100 - z) tan a.
  const double a = 0.2;
  const auto indices = plannedIndices(uprightChest(), {{0, -50, 100}, {1, 0, 0}, -a, {}});
  ASSERT_TRUE(indices);
  EXPECT_NEAR(indices->after.sternumToVertebra, 50 + (100 - indices->after.z) * std::tan(a), 1e-9);
  // The level of least distance is now the highest of the body's lower half.
  EXPECT_NEAR(indices->after.z, 30, 5);
}

TEST(PlannedIndices, ASternumBeforeTheRibsBecomesTheWall) {
  const auto indices = plannedIndices(uprightChest(), {{}, {1, 0, 0}, 0, {0, -45, 0}});
  ASSERT_TRUE(indices);
  EXPECT_NEAR(indices->after.deepestInnerWall, 95, 1e-12);
  EXPECT_NEAR(indices->after.correctionIndex(), 0, 1e-12);
}

TEST(PlannedIndices, AreUnknownWithoutALevel) {
  Anatomy anatomy = uprightChest();
  anatomy.metrics.clear();
  EXPECT_FALSE(plannedIndices(anatomy, {}));
}

TEST(WithSkin, MeasuresAFrontThatCameForwardAgainstTheOldBack) {
  // Skin: summits 90 mm before the vertebra at x = -60 and 60, a pit at -70 between; the back 60 mm behind it.
  Anatomy anatomy = uprightChest();
  for (LevelMetrics& level : anatomy.metrics) {
    anatomy.skin.push_back({level.z, {{-120, 0, level.z}, {-60, -90, level.z}, {0, -70, level.z}, {60, -90, level.z}, {120, 0, level.z}}, false});
    anatomy.vertebralFront.push_back({0, 0, level.z});
    level.externalWidth = 260, level.externalPit = 130, level.externalFront = 150;
  }
  const auto forward = [](double z, Vec3, double) { return std::vector<Vec3>{{-60, -90, z}, {0, -85, z}, {60, -90, z}}; };
  for (const LevelMetrics& level : withSkin(anatomy.metrics, anatomy, forward)) {
    EXPECT_NEAR(level.externalPit, 145, 1e-9);
    EXPECT_NEAR(level.externalFront, 150, 1e-9);
    EXPECT_NEAR(level.concavityArea, 0.5 * 120 * 5, 1e-9);
  }
}
