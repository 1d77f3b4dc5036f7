#include "plugins/segmenter/thorax/outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace pectora::thorax;

namespace {

/// Ellipse as a polygon of many sides, half axes a and b, turned by `angle`, positive area.
Loop ellipse(double a, double b, double angle, Point2 centre, int sides = 2000, double scale = 1) {
  Loop loop;
  for (int i = 0; i < sides; ++i) {
    const double t = 2 * std::numbers::pi * i / sides, x = scale * a * std::cos(t), y = scale * b * std::sin(t);
    loop.push_back({centre.x + x * std::cos(angle) - y * std::sin(angle), centre.y + x * std::sin(angle) + y * std::cos(angle)});
  }
  return loop;
}

/// An L, which has no symmetry.
Loop letter() { return {{0, 0}, {6, 0}, {6, 2}, {2, 2}, {2, 9}, {0, 9}}; }

Loop moved(const Loop& loop, double scale, double angle, Point2 shift) {
  Loop result;
  for (Point2 p : loop)
    result.push_back({shift.x + scale * (p.x * std::cos(angle) - p.y * std::sin(angle)),
                      shift.y + scale * (p.x * std::sin(angle) + p.y * std::cos(angle))});
  return result;
}

TEST(Shape, OfAnEllipseHasItsAreaCentroidAxesAndAngle) {
  const double a = 9, b = 4, angle = 0.6;
  const Shape s = shapeOf(ellipse(a, b, angle, {120, -45}));
  EXPECT_NEAR(s.area, std::numbers::pi * a * b, 1e-3);
  EXPECT_NEAR(s.centroid.x, 120, 1e-9);
  EXPECT_NEAR(s.centroid.y, -45, 1e-9);
  EXPECT_NEAR(s.spreadMajor, a / 2, 1e-4);  // the variance of an ellipse along its half axis a is a^2 / 4
  EXPECT_NEAR(s.spreadMinor, b / 2, 1e-4);
  EXPECT_NEAR(s.angle, angle, 1e-6);
}

TEST(Shape, OfAnEllipseHasHusMomentsInClosedForm) {
  const double a = 7, b = 3;
  const Shape s = shapeOf(ellipse(a, b, 1.1, {3, 4}));
  // eta20 = a / (4 pi b), eta02 = b / (4 pi a); odd moments vanish.
  const double e20 = a / (4 * std::numbers::pi * b), e02 = b / (4 * std::numbers::pi * a);
  EXPECT_NEAR(s.hu[0], e20 + e02, 1e-5);
  EXPECT_NEAR(s.hu[1], (e20 - e02) * (e20 - e02), 1e-5);
  for (int n = 2; n < 7; ++n) EXPECT_NEAR(s.hu[n], 0, 1e-12);
}

TEST(Shape, OfASquareHasHusFirstMomentOneSixth) {
  const Shape s = shapeOf({{1, 1}, {4, 1}, {4, 4}, {1, 4}});
  EXPECT_DOUBLE_EQ(s.area, 9);
  EXPECT_NEAR(s.hu[0], 1.0 / 6, 1e-14);
  for (int n = 1; n < 7; ++n) EXPECT_NEAR(s.hu[n], 0, 1e-14);
}

TEST(Shape, KeepsHusMomentsUnderShiftTurnAndScale) {
  const Shape s = shapeOf(letter()), t = shapeOf(moved(letter(), 3.7, 2.1, {500, -800}));
  EXPECT_NEAR(t.area, 3.7 * 3.7 * s.area, 1e-9 * t.area);
  for (int n = 0; n < 7; ++n) EXPECT_NEAR(t.hu[n], s.hu[n], 1e-9 * std::abs(s.hu[n])) << n;
  EXPECT_GT(std::abs(s.hu[2]), 1e-4);  // the letter is not symmetric, so this test says something
}

TEST(Shape, OfAReversedLoopDiffersOnlyInTheAreasSign) {
  Loop back = letter();
  std::reverse(back.begin(), back.end());
  const Shape s = shapeOf(letter()), t = shapeOf(back);
  EXPECT_DOUBLE_EQ(t.area, -s.area);
  EXPECT_NEAR(t.centroid.x, s.centroid.x, 1e-12);
  EXPECT_NEAR(t.spreadMajor, s.spreadMajor, 1e-12);
  for (int n = 0; n < 7; ++n) EXPECT_NEAR(t.hu[n], s.hu[n], 1e-12);
}

TEST(Shape, OfADegenerateLoopIsZeroAndNotNan) {
  EXPECT_EQ(shapeOf({}).area, 0);
  EXPECT_EQ(shapeOf({{1, 1}, {2, 2}, {3, 3}}).area, 0);
}

TEST(IsoContours, FindADiscAtSubpixelPrecision) {
  Plane plane(64, 64);
  const double x = 31.3, y = 28.8, r = 17.4;
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 64; ++i) plane.at(i, j) = float(100 * (r - std::hypot(i - x, j - y)));
  const std::vector<Loop> loops = isoContours(plane, 0);
  ASSERT_EQ(loops.size(), 1u);
  for (const Point2& p : loops[0]) EXPECT_NEAR(std::hypot(p.x - x, p.y - y), r, 0.01);  // curvature within a pixel
  const Shape s = shapeOf(loops[0]);
  EXPECT_NEAR(s.area, std::numbers::pi * r * r, 2);
  EXPECT_NEAR(s.centroid.x, x, 0.01);
  EXPECT_NEAR(s.centroid.y, y, 0.01);
}

TEST(IsoContours, GiveHolesNegativeArea) {
  Plane plane(40, 40);
  for (int j = 0; j < 40; ++j)
    for (int i = 0; i < 40; ++i) {
      const double r = std::hypot(i - 20, j - 20);
      plane.at(i, j) = r < 15 && r > 6 ? 1.0f : 0.0f;
    }
  const std::vector<Loop> loops = isoContours(plane, 0.5f);
  ASSERT_EQ(loops.size(), 2u);
  const double a = shapeOf(loops[0]).area, b = shapeOf(loops[1]).area;
  EXPECT_GT(std::max(a, b), 600);
  EXPECT_LT(std::min(a, b), -90);
}

TEST(IsoContours, CloseAtThePicturesBorder) {
  const Plane full(5, 4, 10);
  const std::vector<Loop> loops = isoContours(full, 1);
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_NEAR(shapeOf(loops[0]).area, 4 * 3, 0.01);
}

TEST(IsoContours, FollowEverySegmentOfACheckerboardOnce) {
  Plane board(9, 9);
  for (int j = 0; j < 9; ++j)
    for (int i = 0; i < 9; ++i) board.at(i, j) = (i + j) % 2 ? 1.0f : -1.1f;
  double area = 0;
  std::size_t loops = 0;
  for (const Loop& loop : isoContours(board, 0)) area += shapeOf(loop).area, ++loops;
  // The corners' mean is below the level: 40 separate diamonds.
  EXPECT_EQ(loops, 40u);
  EXPECT_GT(area, 0);
}

TEST(IsoContours, OfAnEmptyOrFlatPlaneAreNone) {
  EXPECT_TRUE(isoContours(Plane(0, 0), 0).empty());
  EXPECT_TRUE(isoContours(Plane(8, 8, -5), 0).empty());
}

TEST(RmsDistance, OfACircleAndAShiftedOneIsBetweenZeroAndTheShift) {
  const Loop a = ellipse(10, 10, 0, {0, 0}, 400), b = ellipse(10, 10, 0, {1, 0}, 400);
  EXPECT_EQ(rmsDistance(a, a), 0);
  // | |c - 1| - 10 | is about |cos t|, whose RMS is 1 / sqrt 2.
  EXPECT_NEAR(rmsDistance(a, b), std::sqrt(0.5), 0.05);
  EXPECT_DOUBLE_EQ(rmsDistance(a, b), rmsDistance(b, a));
}

TEST(IsInside, TellsThePocketOfALetterFromItsBody) {
  EXPECT_TRUE(isInside(letter(), {1, 8}));
  EXPECT_FALSE(isInside(letter(), {4, 5}));
  EXPECT_FALSE(isInside(letter(), {-1, 1}));
}

}  // namespace
