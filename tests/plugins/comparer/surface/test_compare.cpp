#include "plugins/comparer/surface/compare.h"
#include "plugins/comparer/surface/hollow.h"

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
  const Comparison c = compareSurfaces(std::make_shared<Mesh>(wall(0, 4)), {wall(0)}, {}, kNoPoll);
  EXPECT_NEAR(c.overlap.mean, 4, 1e-12);
  EXPECT_NEAR(c.overlap.sd, 0, 1e-9);
  EXPECT_EQ(c.overlap.count, 39u * 39);
  EXPECT_EQ(c.excluded, 41u * 41 - 39u * 39);
}

TEST(Compare, TakesPointClouds) {
  auto cloud = std::make_shared<Points>();
  cloud->points = {{1, -2, 3}, {4, 3, -7}};
  const Comparison c = compareSurfaces(cloud, {wall(0)}, {}, kNoPoll);
  EXPECT_NEAR(c.overlap.max, 2, 1e-12);
  EXPECT_NEAR(c.overlap.min, -3, 1e-12);
  const auto& sample = dynamic_cast<const Points&>(*c.sample);
  ASSERT_EQ(sample.fields.size(), 2u);
  EXPECT_NEAR(sample.fields[0].values[0], 2, 1e-12);
}

TEST(Compare, SeesThePitWhereTheReferenceDiffersFromBefore) {
  const Mesh before = wall(30), after = wall(5);
  const Comparison c = compareSurfaces(std::make_shared<Mesh>(wall(3)), {after, &before}, {}, kNoPoll);
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
  const Comparison c = compareSurfaces(std::make_shared<Mesh>(before), {after, &before}, {}, kNoPoll);
  EXPECT_NEAR(c.baselinePit.rms, 0, 1e-9);
  EXPECT_GT(c.pit.rms, 5);
}

TEST(Compare, HistogramCountsEveryPointOnce) {
  const Mesh before = wall(30);
  const Comparison c = compareSurfaces(std::make_shared<Mesh>(before), {wall(0)}, {}, kNoPoll);
  std::size_t total = 0;
  for (std::size_t n : c.histogram.counts) total += n;
  EXPECT_EQ(total, c.overlap.count);
  EXPECT_LE(c.histogram.low, c.overlap.min);
}

TEST(Compare, RefusesSurfacesThatDoNotMeet) {
  auto cloud = std::make_shared<Points>();
  EXPECT_THROW(compareSurfaces(cloud, {wall(0)}, {}, kNoPoll), Error);
  cloud->points = {{0, 500, 0}};
  EXPECT_THROW(compareSurfaces(cloud, {wall(0)}, {}, kNoPoll), Error);
  cloud->points = {{0, NAN, 0}};
  EXPECT_THROW(compareSurfaces(cloud, {wall(0)}, {}, kNoPoll), Error);
}

TEST(Compare, MeasuresBothWaysAndPositiveStaysOutside) {
  // A plane 4 mm outside of a larger one: every measure is 4.
  const Comparison c = compareSurfaces(std::make_shared<Mesh>(wall(0, 4)), {wall(0)}, {}, kNoPoll);
  EXPECT_NEAR(c.reverseOverlap.mean, 4, 1e-12);
  const SymmetricDistances both = symmetric(c.overlap, c.reverseOverlap);
  EXPECT_NEAR(both.meanAbsolute, 4, 1e-12);
  EXPECT_NEAR(both.rms, 4, 1e-12);
  EXPECT_NEAR(both.hd95, 4, 1e-12);
  EXPECT_NEAR(both.hausdorff, 4, 1e-12);
  ASSERT_TRUE(c.reference);
  EXPECT_EQ(c.reference->fields.at(0).values.size(), 41u * 41);
}

TEST(Compare, SeesFromTheOtherSideWhatTheSampleMisses) {
  // The sample is flat and coarse, the reference has a pit: only the way back finds its bottom exactly.
  const Comparison c = compareSurfaces(std::make_shared<Mesh>(wall(0)), {wall(20)}, {}, kNoPoll);
  EXPECT_NEAR(c.reverseOverlap.max, 20, 1e-9);
  EXPECT_LT(c.overlap.max, 20);
  EXPECT_NEAR(symmetric(c.overlap, c.reverseOverlap).hausdorff, 20, 1e-9);
}

TEST(Compare, MeasuresOneWayIfAskedOrGivenACloud) {
  CompareSettings settings;
  settings.bothWays = false;
  EXPECT_EQ(compareSurfaces(std::make_shared<Mesh>(wall(0)), {wall(1)}, settings, kNoPoll).reverseOverlap.count, 0u);
  auto cloud = std::make_shared<Points>();
  cloud->points = {{1, -2, 3}};
  const Comparison c = compareSurfaces(cloud, {wall(0)}, {}, kNoPoll);
  EXPECT_EQ(c.reverseOverlap.count, 0u);
  EXPECT_EQ(c.parts().size(), 1u);
}

TEST(Compare, CountsEveryPointInThePapersRows) {
  // Half of the sample lies beyond the reference's border, 3 mm outside of its plane.
  auto cloud = std::make_shared<Points>();
  cloud->points = {{0, -3, 0}, {110, 0, 0}};
  const Comparison full = compareSurfaces(cloud, {wall(0)}, {}, kNoPoll);
  EXPECT_EQ(full.overlap.count, 1u);
  EXPECT_EQ(full.everywhere.count, 2u);
  EXPECT_NEAR(full.everywhere.mean, (3 + 10) / 2.0, 1e-12);
  EXPECT_NEAR(full.everywhere.sd, 3.5, 1e-12);
  const auto& leftOut = dynamic_cast<const Points&>(*full.sample).fields.at(1);
  EXPECT_EQ(leftOut.values, (std::vector<double>{0, 1}));
  CompareSettings settings;
  settings.isPaper = true;
  const Comparison paper = compareSurfaces(cloud, {wall(0)}, settings, kNoPoll);
  EXPECT_EQ(paper.overlap.count, 2u);
  EXPECT_EQ(paper.excluded, 0u);
}

TEST(Compare, HoldsAPredictionAgainstSkinThatCopiesTheBone) {
  const Mesh before = wall(30), after = wall(5), copied = wall(0);
  const Comparison c = compareSurfaces(std::make_shared<Mesh>(wall(4)), {after, &before, &copied}, {}, kNoPoll);
  EXPECT_EQ(c.copiedPit.count, c.pit.count);
  EXPECT_NEAR(c.skillAgainstCopy(), 1 - c.pit.rms / c.copiedPit.rms, 1e-12);
  EXPECT_NEAR(c.skillAgainstCopy(), 0.75, 0.02);   // 1 mm off against 4 mm off
}

TEST(Hollow, IsAsDeepAsTheStringOverTheFrontSays) {
  const Mesh skin = wall(30);
  const std::vector<double> depths = hollowDepths(skin);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    // In the slice through z the string hangs on the slice's own ends, 100 mm beside the middle.
    const Vec3 p = skin.points[i];
    const double ends = 30 * std::exp(-(100 * 100 + p.z * p.z) / (2 * 900));
    // Slices are 2 mm apart, rows 5 mm: between slices the string misses half of what a row bends by, 5 mm times the second derivative of
    // its ends, which is 30 exp(-100^2 / 1800) / 900 = 1.3e-4 / mm at the most.
    EXPECT_NEAR(depths[i], std::max(0.0, p.y - ends), 4e-4) << p.x << ' ' << p.z;
  }
}

TEST(Hollow, IsNothingOnARoundBodyAndOnItsBack) {
  // A cylinder with a groove of 10 mm down its front and one down its back.
  std::vector<Vec3> points;
  constexpr int kRows = 11, kColumns = 181;
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kColumns; ++c) {
      const double angle = 2 * M_PI * c / (kColumns - 1), x = -100 * std::cos(angle), y = -100 * std::sin(angle);
      const double groove = 10 * std::exp(-x * x / 200);
      points.push_back({x, y + (y < 0 ? groove : -groove), 10.0 * r});
    }
  const Mesh body = layerMesh(kRows, kColumns, points);
  const std::vector<double> depths = hollowDepths(body);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const Vec3 p = body.points[i];
    if (p.y > 0 || std::abs(p.x) > 45) {
      EXPECT_LT(depths[i], 1e-6) << p.x << ' ' << p.y;
    }
    if (p.y < 0 && std::abs(p.x) < 1e-9) {
      EXPECT_NEAR(depths[i], 10 - 2.6, 1);   // the string cuts the circle between the groove's shoulders
    }
  }
}

TEST(Compare, MeasuresEveryPredictionOverTheSameHollow) {
  const Mesh before = wall(30), copied = wall(0);
  const auto scan = std::make_shared<Mesh>(wall(4));
  std::vector<ComparedRegion> hollows;
  std::vector<std::size_t> pits;
  for (double predicted : {5.0, 15.0, 26.0}) {
    const Comparison c = compareSurfaces(scan, {wall(predicted), &before, &copied}, {}, kNoPoll);
    ASSERT_EQ(c.regions.at(0).name, "hollow");
    hollows.push_back(c.regions[0]);
    pits.push_back(c.pit.count);
    EXPECT_NEAR(c.regions[0].skill(), 1 - c.regions[0].distances.rms / c.regions[0].unchanged.rms, 1e-12);
    EXPECT_NEAR(c.regions[0].skillAgainstCopy(), 1 - c.regions[0].distances.rms / c.regions[0].copied.rms, 1e-12);
    EXPECT_GT(c.regions[0].reverse.count, 0u);
  }
  EXPECT_GT(pits[0], pits[2]);   // a timid prediction shrinks its own pit
  for (const ComparedRegion& h : hollows) {
    EXPECT_EQ(h.distances.count, hollows[0].distances.count);
    EXPECT_EQ(h.unchanged.rms, hollows[0].unchanged.rms);
    EXPECT_EQ(h.copied.rms, hollows[0].copied.rms);
  }
  EXPECT_GT(hollows[0].skill(), hollows[1].skill());
  // Deeper than 3 mm within sqrt(2 900 ln(30 / 3)) = 64.4 mm of the middle, and 10 mm around that.
  const Comparison c = compareSurfaces(scan, {wall(5), &before}, {}, kNoPoll);
  const PointField& field = dynamic_cast<const Mesh&>(*c.sample).fields.at(3);
  ASSERT_EQ(field.name, "hollow");
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    const double off = std::hypot(scan->points[i].x, scan->points[i].z);
    // Between them lies the grid: a triangle belongs to it with one corner, up to 7 mm further.
    if (off < 65 || off > 85) {
      EXPECT_EQ(field.values[i], off < 65) << off;
    }
  }
}

TEST(Compare, MeasuresRegionsOfOnesOwn) {
  CompareSettings settings;
  settings.regions = {parseRegion("middle = ball 0 0 0 20"), parseRegion("right=box -100 -50 -9 9 -99 99")};
  const Comparison c = compareSurfaces(std::make_shared<Mesh>(wall(0, 2)), {wall(0)}, settings, kNoPoll);
  ASSERT_EQ(c.regions.size(), 2u);
  EXPECT_EQ(c.regions[0].name, "middle");
  EXPECT_EQ(c.regions[0].distances.count, 49u);   // grid points within 4 steps of the middle
  EXPECT_EQ(c.regions[1].distances.count, 10u * 39);
  EXPECT_NEAR(c.regions[1].reverse.mean, 2, 1e-12);
}

TEST(Compare, RefusesRegionsThatAreNone) {
  for (const char* text : {"", "a", "a = ", "a = ball 1 2 3", "a = ball 1 2 3 -4", "a = box 0 1 0 1 1 0", "a = cone 1 2 3 4", "a b = ball 1 2 3 4", "pit = ball 1 2 3 4", "hollow = ball 1 2 3 4", "a = ball 1 2 3 4 x",
                           "A-B = ball 1 2 3 4"})
    EXPECT_THROW(parseRegion(text), Error) << text;
}

TEST(Compare, IsTheSameTurnedInsideOutButForTheSign) {
  Mesh inside = wall(10);
  for (auto& t : inside.triangles) std::swap(t[1], t[2]);
  const auto sample = std::make_shared<Mesh>(wall(7, 1));
  const Comparison a = compareSurfaces(sample, {wall(10)}, {}, kNoPoll), b = compareSurfaces(sample, {inside}, {}, kNoPoll);
  EXPECT_DOUBLE_EQ(a.overlap.mean, -b.overlap.mean);
  EXPECT_DOUBLE_EQ(a.overlap.max, -b.overlap.min);
}

TEST(Compare, RefusesHugeCoordinates) {
  auto cloud = std::make_shared<Points>();
  cloud->points = {{0, 1e200, 0}};
  EXPECT_THROW(compareSurfaces(cloud, {wall(0)}, {}, kNoPoll), Error);
}
