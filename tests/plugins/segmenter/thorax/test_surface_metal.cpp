// Metal on the skin, and bone below it.
#include "plugins/segmenter/thorax/surface_metal.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pectora::thorax;

namespace {

constexpr float kAir = -1000, kFat = -100, kBone = 800, kWire = 2000;
constexpr double kRadius = 45;

/// A slice of 1 mm pixels: fat around (60, 60), a rib 6 mm below its front, and metal 15 mm wide and `wireThick` pixels thick on it.
Plane chest(int wireThick) {
  Plane plane(121, 121, kAir);
  for (int j = 0; j < 121; ++j)
    for (int i = 0; i < 121; ++i) {
      if (std::hypot(i - 60, j - 60) <= kRadius) plane.at(i, j) = kFat;
      if (std::hypot((i - 60) / 8.0, (j - 24) / 3.0) <= 1) plane.at(i, j) = kBone;
      if (std::abs(i - 60) < 8 && j < 60 - kRadius && j >= 60 - kRadius - wireThick) plane.at(i, j) = kWire;
    }
  return plane;
}

TEST(RemoveSurfaceMetal, TakesAWireOffTheSkin) {
  const Plane bare = chest(0);
  Plane plane = chest(3);
  removeSurfaceMetal(plane, {1, 1, 1}, -490);
  // Grown by one pixel it takes one of skin with it.
  for (int j = 0; j < 121; ++j)
    for (int i = 0; i < 121; ++i)
      if (j > 60 - kRadius + 1 || std::abs(i - 60) > 9) {
        EXPECT_EQ(plane.at(i, j), bare.at(i, j)) << i << ", " << j;
      }
  for (int j = 0; j < 60 - kRadius; ++j) EXPECT_EQ(plane.at(60, j), kAir);
}

TEST(RemoveSurfaceMetal, LeavesBoneAndNoiseWhereTheyAre) {
  Plane plane = chest(0);
  plane.at(60, 16) = 300;   // a pixel of noise in the skin
  const Plane before = plane;
  removeSurfaceMetal(plane, {1, 1, 1}, -490);
  EXPECT_EQ(plane.value, before.value);
}

TEST(RemoveSurfaceMetal, LeavesWhatIsTooLargeForAWire) {
  Plane plane = chest(14);   // 15 x 14 mm
  const Plane before = plane;
  removeSurfaceMetal(plane, {1, 1, 1}, -490);
  EXPECT_EQ(plane.value, before.value);
}

}  // namespace
