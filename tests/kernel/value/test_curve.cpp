#include "kernel/value/curve.h"

#include <gtest/gtest.h>

using namespace pectora;

namespace {

// A cubic spline with seven control points in general position.
Curve wavy() {
  Curve curve;
  curve.knots = clampedKnots(7, 3);
  for (int i = 0; i < 7; ++i) curve.controls.push_back({10.0 * i, 5.0 * ((i * 3) % 4), 2.0 * i * (i % 2)});
  return curve;
}

}  // namespace

TEST(Curve, StartsAndEndsAtItsOuterControlPoints) {
  const Curve curve = wavy();
  EXPECT_LT(distance(curve.at(0), curve.controls.front()), 1e-12);
  EXPECT_LT(distance(curve.at(1), curve.controls.back()), 1e-12);
}

TEST(Curve, BasisFunctionsSumToOneEverywhere) {
  const Curve curve = wavy();
  for (int i = 0; i <= 100; ++i) {
    double sum = 0;
    for (double w : basis(curve.knots, 3, i / 100.0).weights) sum += w;
    EXPECT_NEAR(sum, 1, 1e-14);
  }
}

TEST(Curve, DerivativeAgreesWithACentralDifference) {
  const Curve curve = wavy();
  const double h = 1e-5;
  for (double u = 0.05; u < 1; u += 0.1) {
    const Vec3 difference = (curve.at(u + h) - curve.at(u - h)) / (2 * h);
    EXPECT_LT(distance(curve.derivative(u), difference), 1e-5);  // h^2 times a third derivative of about 1e4
  }
}

TEST(Curve, LengthAgreesWithAFinePolyline) {
  const Curve curve = wavy();
  EXPECT_NEAR(curve.length(), polylineLength(curve.sample(20001)), 1e-3);
}

TEST(Curve, LengthOfAParabolaIsItsClosedForm) {
  // y = x^2 from 0 to 1, in one piece and in two, scaled to a size in mm.
  const double exact = 100 * (std::sqrt(5.0) / 2 + std::asinh(2.0) / 4);
  const Curve whole{2, clampedKnots(3, 2), {{0, 0, 0}, {50, 0, 0}, {100, 100, 0}}};
  EXPECT_NEAR(whole.length(), exact, 1e-9);
  const Curve halves{2, clampedKnots(4, 2), {{0, 0, 0}, {25, 0, 0}, {75, 50, 0}, {100, 100, 0}}};
  EXPECT_NEAR(halves.length(), exact, 1e-9);
  // The same, with its degree raised.
  const Curve cubic{3, clampedKnots(4, 3), {{0, 0, 0}, {100.0 / 3, 0, 0}, {200.0 / 3, 100.0 / 3, 0}, {100, 100, 0}}};
  EXPECT_NEAR(cubic.length(), exact, 1e-9);
  const Curve line{1, clampedKnots(2, 1), {{1, 2, 3}, {4, 6, 15}}};
  EXPECT_NEAR(line.length(), 13, 1e-12);
}

TEST(Curve, ClosestPointIsPerpendicular) {
  const Curve curve = wavy();
  const Vec3 p{31, 20, 3};
  const double u = curve.closest(p);
  ASSERT_GT(u, 0);
  ASSERT_LT(u, 1);
  EXPECT_NEAR(dot(p - curve.at(u), normalized(curve.derivative(u))), 0, 1e-3);
}

TEST(Polyline, ResamplingKeepsEndsAndSpacesPointsEqually) {
  const std::vector<Vec3> corner{{0, 0, 0}, {10, 0, 0}, {10, 20, 0}};
  const std::vector<Vec3> points = resamplePolyline(corner, 7);
  EXPECT_LT(distance(points.front(), corner.front()), 1e-12);
  EXPECT_LT(distance(points.back(), corner.back()), 1e-12);
  EXPECT_LT(distance(points[2], {10, 0, 0}), 1e-12);
  EXPECT_LT(distance(points[5], {10, 15, 0}), 1e-12);
}
