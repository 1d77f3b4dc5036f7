// The inner wall, the sternum's landmarks and the indices.
#include "plugins/segmenter/thorax/segment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace pectora;
using namespace pectora::thorax;

namespace {

PolarGrid straightGrid(int slices) {
  PolarGrid grid;
  grid.poleX.assign(slices, 100);
  grid.poleY = 150;
  return grid;
}

Loop circle(double x, double y, double r, int sides = 360) {
  Loop loop;
  for (int i = 0; i < sides; ++i) {
    const double t = 2 * std::numbers::pi * i / sides;
    loop.push_back({x + r * std::cos(t), y + r * std::sin(t)});
  }
  return loop;
}

TEST(PolarGrid, PutsItsFirstQuarterTurnsOnTheCoronalPlane) {
  const PolarGrid grid = straightGrid(1);
  EXPECT_DOUBLE_EQ(PolarGrid::degrees(PolarGrid::kAngles / 2), 0);
  EXPECT_NEAR(grid.at(0, -90, 50).y, 150, 1e-12);
  EXPECT_NEAR(grid.at(0, -90, 50).x, 50, 1e-12);
  EXPECT_NEAR(grid.at(0, 0, 50).y, 100, 1e-12);
}

TEST(OutlineRadii, OfACircleAboutThePoleAreItsRadius) {
  const std::vector<double> radii = outlineRadii(circle(100, 150, 80), straightGrid(1), 0);
  for (double r : radii) EXPECT_NEAR(r, 80, 0.01);
}

TEST(OutlineRadii, AreMissingWhereTheOutlineIsNot) {
  const std::vector<double> radii = outlineRadii(circle(100, 100, 10), straightGrid(1), 0);
  EXPECT_NEAR(radii[PolarGrid::kAngles / 2], 40, 0.01);  // the near side
  EXPECT_LT(radii.front(), 0);
}

TEST(FitWall, BridgesAHoleInASmoothSurface) {
  // A wall r = 100 + 10 cos(angle) + 0.1 z of which a window of 50 degrees by 40 mm is not seen.
  const int slices = 60;
  std::vector<WallSample> samples;
  std::vector<std::vector<double>> skin(slices, std::vector<double>(PolarGrid::kAngles, 140));
  const auto truth = [](int n, int s) { return 100 + 10 * std::cos(PolarGrid::degrees(n) * 0.0174533) + 0.2 * s; };
  for (int s = 0; s < slices; ++s)
    for (int n = 0; n < PolarGrid::kAngles; ++n)
      if (std::abs(PolarGrid::degrees(n)) > 25 || std::abs(s - 30) > 10) samples.push_back({double(n), double(s), truth(n, s), 1});
  const std::vector<double> wall = fitWall(samples, usualWall(samples, {}, skin, 0, 2), 0, slices - 1, 2, 0.02);
  double worst = 0;
  for (int s = 0; s < slices; ++s)
    for (int n = 0; n < PolarGrid::kAngles; ++n)
      worst = std::max(worst, std::abs(wall[std::size_t(s) * PolarGrid::kAngles + n] - truth(n, s)));
  EXPECT_LT(worst, 0.8);  // of 10 mm of curvature that the hole hides a tenth; the pull to the usual wall adds a little
}

TEST(FitWall, OfASingleSliceIsItsSamples) {
  std::vector<WallSample> samples;
  for (int n = 0; n < PolarGrid::kAngles; ++n) samples.push_back({double(n), 0, 80, 1});
  const std::vector<std::vector<double>> skin(1, std::vector<double>(PolarGrid::kAngles, 100));
  for (double r : fitWall(samples, usualWall(samples, {}, skin, 0, 5), 0, 0, 5, 0.02)) EXPECT_NEAR(r, 80, 1e-3);
}

/// A sternum of 150 slices of 1 mm from z = 200: manubrium steep, body less so, the last 25 slices narrow; its body turned
/// by `turn` degrees with the left side deeper.
std::vector<SternumSlice> sternum(double turn) {
  std::vector<SternumSlice> slices;
  for (int n = 0; n < 150; ++n) {
    SternumSlice s;
    s.slice = 200 - n;
    s.isSeen = true;
    // Forward by tan 38 degrees down to the joint at 45 mm, by tan 15 degrees below.
    const double y = 100 - (n < 45 ? 0.781 * n : 0.781 * 45 + 0.268 * (n - 45));
    const double halfWidth = n < 125 ? 18 : 7, halfDepth = 5, a = turn * 0.0174533;
    for (auto [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      const double x = u * halfWidth, d = v * halfDepth;
      s.contour.push_back({50 + x * std::cos(a) - d * std::sin(a), y + x * std::sin(a) + d * std::cos(a)});
    }
    s.shape = shapeOf(s.contour);
    slices.push_back(s);
  }
  return slices;
}

TEST(MeasureSternum, FindsJointsTiltAndTorsion) {
  const Sternum s = measureSternum(sternum(12), 1, 0);
  EXPECT_NEAR(s.jugularNotch.z, 200, 1e-9);
  EXPECT_NEAR(s.manubriosternalJoint.z, 155, 3);
  EXPECT_NEAR(s.xiphisternalJoint.z, 76, 1);
  EXPECT_NEAR(s.tiltDeg, 15, 0.3);
  EXPECT_NEAR(s.torsionDeg, 12, 0.3);  // positive: the left side is deeper
  ASSERT_EQ(s.notches.size(), 14u);
  for (const Notch& notch : s.notches) EXPECT_EQ(notch.side == Side::right, notch.position.x < 50) << notch.rib;
  for (std::size_t n = 2; n < s.notches.size(); ++n) EXPECT_LT(s.notches[n].position.z, s.notches[n - 2].position.z);
}

TEST(MeasureSternum, TakesThePatientsTurnFromTheTorsion) {
  EXPECT_NEAR(measureSternum(sternum(12), 1, 5).torsionDeg, measureSternum(sternum(12), 1, 0).torsionDeg - 5, 1e-9);
}

TEST(LungBehindRibs, IsTheGapWhereBothAreKnownAndSpreadsAround) {
  // Lung on every ray of 40 slices, 8 mm behind the ribs in the lower half and right at them in the upper half.
  std::vector<std::vector<double>> lung(40, std::vector<double>(PolarGrid::kAngles, 100));
  std::vector<WallSample> ribs;
  for (int s = 0; s < 40; s += 4)
    for (int n = 0; n < PolarGrid::kAngles; n += 5) ribs.push_back({double(n), double(s), s < 20 ? 108.0 : 100.0, 1});
  const auto behind = lungBehindRibs(ribs, lung, 0, 5);
  EXPECT_NEAR(behind[2 * PolarGrid::kAngles + 80], 8, 0.3);
  EXPECT_NEAR(behind[37 * PolarGrid::kAngles + 80], 0, 0.3);
}

TEST(MeasureSternum, OfNothingIsEmpty) { EXPECT_TRUE(measureSternum({}, 1, 0).axis.empty()); }

}  // namespace
