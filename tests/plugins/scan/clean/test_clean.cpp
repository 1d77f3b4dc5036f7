#include "plugins/scan/clean/clean.h"

#include "kernel/stage/error.h"

#include <gtest/gtest.h>

#include <limits>

using namespace pectora;

namespace {

const auto kNoPoll = [](double) {};

// A front of a body, 2 mm apart, in two sweeps; it bulges towards -y.
Points front() {
  Points scan;
  for (int r = 0; r < 60; ++r)
    for (int c = 0; c < 60; ++c) {
      const double x = 2.0 * (c - 30), z = 2.0 * (r - 30);
      scan.points.push_back({x, (x * x + z * z) / 200, z});
      scan.sweeps.push_back(r < 30 ? 0 : 1);
    }
  return scan;
}

}  // namespace

TEST(Clean, KeepsAGoodScanWholeWithItsSweepsApart) {
  const Cleaned made = clean(front(), {}, kNoPoll);
  EXPECT_EQ(made.points.points, front().points);
  EXPECT_EQ(made.points.sweeps, front().sweeps);
  EXPECT_EQ(made.notFinite + made.duplicates + made.outliers, 0u);
}

TEST(Clean, TakesOutWhatIsNoSkinAndSaysHowMuch) {
  Points scan = front();
  for (int i = 0; i < 20; ++i) scan.points.push_back({15.0 * i - 150, -40, 3.0 * i}), scan.sweeps.push_back(1);
  for (int i = 0; i < 7; ++i) scan.points.push_back(scan.points[100 * i]), scan.sweeps.push_back(0);
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) scan.points.push_back({0, bad, 0}), scan.sweeps.push_back(0);
  const Cleaned made = clean(scan, {}, kNoPoll);
  EXPECT_EQ(made.notFinite, 3u);
  EXPECT_EQ(made.duplicates, 7u);
  EXPECT_EQ(made.outliers, 20u);
  EXPECT_EQ(made.points.points, front().points);
  EXPECT_EQ(made.points.sweeps, front().sweeps);
}

TEST(Clean, FindsNormalsThatPointOutOfTheBody) {
  const Cleaned made = clean(front(), {}, kNoPoll);
  ASSERT_TRUE(made.estimatedNormals);
  ASSERT_EQ(made.points.normals.size(), made.points.points.size());
  for (std::size_t i = 0; i < made.points.normals.size(); ++i) {
    const Vec3 p = made.points.points[i], truth = normalized({p.x / 100, -1, p.z / 100});
    EXPECT_GT(dot(made.points.normals[i], truth), 0.98);
  }
}

TEST(Clean, KeepsNormalsThatAreThere) {
  Points scan = front();
  scan.normals.assign(scan.points.size(), Vec3{0, -1, 0});
  const Cleaned made = clean(scan, {}, kNoPoll);
  EXPECT_FALSE(made.estimatedNormals);
  EXPECT_EQ(made.points.normals, scan.normals);
}

TEST(Clean, RefusesAScanOfWhichNothingStays) {
  EXPECT_THROW(clean(Points{}, {}, kNoPoll), Error);
  Points scan;
  scan.points.assign(1000, Vec3{1, 2, 3});
  EXPECT_THROW(clean(scan, {}, kNoPoll), Error);
}
