#include "plugins/splines/cartilage/cage.h"
#include "plugins/splines/cartilage/fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace pectora;

namespace {

std::vector<Vec3> helix(int count, double noise) {
  std::vector<Vec3> points;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> jitter(-noise, noise);
  for (int i = 0; i < count; ++i) {
    const double t = 3.0 * i / (count - 1);
    points.push_back({120 * std::cos(t) + jitter(random), 90 * std::sin(t) + jitter(random), -40 * t + jitter(random)});
  }
  return points;
}

// Ribs 4 to 9 of one side, ending at junctions, and the notches they need.
std::shared_ptr<Anatomy> halfCage() {
  auto anatomy = std::make_shared<Anatomy>();
  for (int number = 4; number <= 9; ++number) {
    Rib rib{Side::left, number, {}, true, true};
    for (int i = 0; i <= 20; ++i) {
      const double t = 2.4 * i / 20;
      rib.centerline.push_back({20 + 110 * std::sin(t), 70 - 90 * (1 - std::cos(t)), -20.0 * number - 30 * t});
    }
    anatomy->ribs.push_back(rib);
    if (number <= 7) anatomy->sternum.notches.push_back({Side::left, number, {18, -95, -60.0 - 8 * number}});
  }
  return anatomy;
}

}  // namespace

TEST(FitCurve, ReproducesASplineFromItsOwnPoints) {
  Curve truth;
  truth.knots = clampedKnots(6, 3);
  // Equal steps of parameter and of arc length agree on a straight line only, so this is one.
  for (int i = 0; i < 6; ++i) truth.controls.push_back({10.0 * i, 4.0 * i, -3.0 * i});
  const Curve fitted = fitCurve(truth.sample(100), 6);
  EXPECT_LT(rmsDistance(fitted, truth.sample(50)), 1e-6);
}

TEST(FitCurve, FollowsASmoothCurveAndMeetsItsEnds) {
  const auto points = helix(60, 0);
  const Curve curve = fitCurve(points, 14);
  EXPECT_LT(rmsDistance(curve, points), 0.05);
  EXPECT_EQ(curve.at(0), points.front());
  EXPECT_LT(distance(curve.at(1), points.back()), 1e-12);
}

TEST(FitCurve, SmoothsNoise) {
  const Curve curve = fitCurve(helix(200, 1), 14);
  EXPECT_LT(rmsDistance(curve, helix(200, 0)), 0.45);
}

TEST(FitCurve, TakesAsFewAsFourPoints) {
  const auto points = helix(4, 0);
  EXPECT_LT(rmsDistance(fitCurve(points, 12), points), 1);
}

TEST(HermiteCurve, HasTheAskedEndsAndTangents) {
  const Vec3 a{90, -80, -150}, b{18, -100, -120}, ta = normalized({-1, -0.4, -0.8}), tb = normalized({-1, 0, 0.9});
  const Curve curve = hermiteCurve(a, ta, b, tb, 0.4, 0.2);
  EXPECT_EQ(curve.at(0), a);
  EXPECT_LT(distance(curve.at(1), b), 1e-12);
  EXPECT_NEAR(dot(normalized(curve.derivative(0)), ta), 1, 1e-12);
  EXPECT_NEAR(dot(normalized(curve.derivative(1)), tb), 1, 1e-12);
  // C'(0) = 3 (P1 - P0).
  EXPECT_NEAR(norm(curve.derivative(0)), 3 * 0.4 * distance(a, b), 1e-9);
  EXPECT_NEAR(norm(curve.derivative(1)), 3 * 0.2 * distance(a, b), 1e-9);
}

TEST(BuildCage, JoinsTrueRibsToTheSternumAndFalseOnesToTheArch) {
  std::vector<std::string> warnings;
  const RibCage cage = buildCage(halfCage(), nullptr, {}, warnings);
  ASSERT_EQ(cage.ribs.size(), 6u);
  ASSERT_EQ(cage.cartilages.size(), 6u);
  for (const Cartilage& c : cage.cartilages) {
    EXPECT_EQ(c.joins, c.rib <= 7 ? 0 : c.rib - 1);
    const RibCurve& rib = cage.ribs[c.rib - 4];
    EXPECT_LT(distance(c.curve.at(0), rib.curve.at(1)), 1e-9) << "begins at the junction";
    EXPECT_NEAR(dot(normalized(c.curve.derivative(0)), normalized(rib.curve.derivative(1))), 1, 0.02) << "and goes on as the rib does";
  }
  EXPECT_LT(distance(cage.cartilages[4].curve.at(1), cage.cartilages[3].curve.at(0.6)), 1e-9);
}

TEST(BuildCage, SaysWhichCartilagesCouldNotBeBuiltAndWhoseRibsEndOutsideTheCt) {
  auto anatomy = halfCage();
  anatomy->ribs[1].reachesJunction = false;  // rib 5
  std::vector<std::string> warnings;
  const RibCage cage = buildCage(anatomy, nullptr, {}, warnings);
  EXPECT_EQ(cage.cartilages.size(), 5u);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("left 5: its front end lies outside the CT"), std::string::npos) << warnings[0];
  EXPECT_EQ(warnings[1].find("left 5"), std::string::npos) << warnings[1];
  EXPECT_NE(warnings[1].find("left 1"), std::string::npos) << warnings[1];
}

TEST(BuildCage, LetsCartilagesFollowThePitThatThePleuraShows) {
  auto anatomy = halfCage();
  // Pleura: a flat front with a pit of 20 mm at the midline.
  const auto depth = [](double x) { return -92 + 20 * std::exp(-x * x / (2 * 15 * 15)); };
  for (double z = -400; z <= 0; z += 5) {
    LayerSlice slice{z, {}, false};
    for (double x = -150; x <= 150; x += 3) slice.points.push_back({x, depth(x), z});
    anatomy->pleura.push_back(slice);
  }
  for (Notch& notch : anatomy->sternum.notches) notch.position.y = depth(notch.position.x) - 6;
  std::vector<std::string> warnings;
  const RibCage cage = buildCage(anatomy, nullptr, {}, warnings);
  for (const Cartilage& c : cage.cartilages) {
    if (c.joins > 0) continue;
    const double first = c.curve.at(0).y - depth(c.curve.at(0).x);
    for (double u = 0.2; u < 1; u += 0.2) {
      const Vec3 p = c.curve.at(u);
      const double offset = p.y - depth(p.x);
      EXPECT_GT(offset, std::min(first, -6.0) - 2.5) << c.rib << " at " << u;
      EXPECT_LT(offset, std::max(first, -6.0) + 2.5) << c.rib << " at " << u;
    }
  }
}
