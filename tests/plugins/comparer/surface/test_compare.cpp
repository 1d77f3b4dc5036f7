#include "plugins/comparer/surface/compare.h"

#include "kernel/stage/error.h"
#include "kernel/value/scene.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pectora;

namespace {

// A wall of 41 x 41 points, 5 mm apart, facing -y, with a Gaussian pit of some depth.
Mesh wall(double pit, double offset = 0) {
  std::vector<Vec3> points;
  for (int r = 0; r < 41; ++r)
    for (int c = 0; c < 41; ++c) {
      const double x = 5.0 * (c - 20), z = 5.0 * (r - 20);
      points.push_back({x, pit * std::exp(-(x * x + z * z) / (2 * 900)) - offset, z});
    }
  return layerMesh(41, 41, std::move(points));
}

const auto kNoPoll = [](double) {};

}  // namespace

TEST(Compare, FindsAParallelShiftExactlyAndOutsideIsPositive) {
  const Comparison c = compareSurfaces(std::make_shared<Mesh>(wall(0, 4)), wall(0), nullptr, {}, kNoPoll);
  EXPECT_NEAR(c.overlap.mean, 4, 1e-12);
  EXPECT_NEAR(c.overlap.sd, 0, 1e-9);
  EXPECT_EQ(c.overlap.count, 39u * 39);
  EXPECT_EQ(c.excluded, 41u * 41 - 39u * 39);
}

TEST(Compare, TakesPointClouds) {
  auto cloud = std::make_shared<Points>();
  cloud->points = {{1, -2, 3}, {4, 3, -7}};
  const Comparison c = compareSurfaces(cloud, wall(0), nullptr, {}, kNoPoll);
  EXPECT_NEAR(c.overlap.max, 2, 1e-12);
  EXPECT_NEAR(c.overlap.min, -3, 1e-12);
  const auto& sample = dynamic_cast<const Points&>(*c.sample);
  ASSERT_EQ(sample.fields.size(), 1u);
  EXPECT_NEAR(sample.fields[0].values[0], 2, 1e-12);
}

TEST(Compare, SeesThePitWhereTheReferenceDiffersFromBefore) {
  const Mesh before = wall(30), after = wall(5);
  const Comparison c = compareSurfaces(std::make_shared<Mesh>(wall(3)), after, &before, {}, kNoPoll);
  EXPECT_GT(c.pit.count, 100u);
  EXPECT_LT(c.pit.count, c.overlap.count);
  EXPECT_NEAR(c.pit.max, 2, 0.05);
  EXPECT_GT(c.baselinePit.rms, 5);
  EXPECT_GT(c.skill(), 0.85);
  EXPECT_EQ(c.pit.count, c.baselinePit.count);
  EXPECT_EQ(c.overlap.count, c.baselineOverlap.count);
}

TEST(Compare, HasSkillZeroForASampleThatIsTheUnchangedSurface) {
  // A scan that shows no change judges the prediction of a change as worse than nothing.
  const Mesh before = wall(30), after = wall(5);
  const Comparison c = compareSurfaces(std::make_shared<Mesh>(before), after, &before, {}, kNoPoll);
  EXPECT_NEAR(c.baselinePit.rms, 0, 1e-9);
  EXPECT_GT(c.pit.rms, 5);
}

TEST(Compare, HistogramCountsEveryPointOnce) {
  const Mesh before = wall(30);
  const Comparison c = compareSurfaces(std::make_shared<Mesh>(before), wall(0), nullptr, {}, kNoPoll);
  std::size_t total = 0;
  for (std::size_t n : c.histogram.counts) total += n;
  EXPECT_EQ(total, c.overlap.count);
  EXPECT_LE(c.histogram.low, c.overlap.min);
}

TEST(Compare, RefusesSurfacesThatDoNotMeet) {
  auto cloud = std::make_shared<Points>();
  EXPECT_THROW(compareSurfaces(cloud, wall(0), nullptr, {}, kNoPoll), Error);
  cloud->points = {{0, 500, 0}};
  EXPECT_THROW(compareSurfaces(cloud, wall(0), nullptr, {}, kNoPoll), Error);
  cloud->points = {{0, NAN, 0}};
  EXPECT_THROW(compareSurfaces(cloud, wall(0), nullptr, {}, kNoPoll), Error);
}
