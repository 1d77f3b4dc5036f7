#include "plugins/register/landmarks/fit.h"

#include "kernel/stage/error.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace pectora;

namespace {

// Neck, navel and nipples of an adult, LPS mm.
const std::vector<Vec3> kTorso{{2, -70, 10}, {0, -110, -340}, {-105, -105, -130}, {104, -107, -132}};
const char* const kNames[] = {"neck", "navel", "nipple_right", "nipple_left", "fifth", "sixth"};

Vec3 transformed(Vec3 p, double scale) {
  const Eigen::Vector3d q = scale * (Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()) * Eigen::Vector3d(p.x, p.y, p.z)) + Eigen::Vector3d(20, -300, 44);
  return {q.x(), q.y(), q.z()};
}

std::vector<LandmarkPair> pairsOf(const std::vector<Vec3>& points, double scale) {
  std::vector<LandmarkPair> pairs;
  for (std::size_t i = 0; i < points.size(); ++i) pairs.push_back({kNames[i], transformed(points[i], scale), points[i]});
  return pairs;
}

}  // namespace

TEST(FitLandmarks, FindsARigidMotionExactly) {
  const auto pairs = pairsOf(kTorso, 1);
  for (const MapKind kind : {MapKind::rigid, MapKind::similarity, MapKind::affine}) {
    const Registration r = fitLandmarks(pairs, kind);
    EXPECT_NEAR(r.rms, 0, 1e-9);
    EXPECT_NEAR(r.scale, 1, 1e-9);
    EXPECT_LT(distance(r.map(transformed({30, -20, -100}, 1)), {30, -20, -100}), 1e-9);
  }
}

TEST(FitLandmarks, FindsTheScaleOfASimilarity) {
  const Registration r = fitLandmarks(pairsOf(kTorso, 1.1), MapKind::similarity);
  EXPECT_NEAR(r.scale, 1 / 1.1, 1e-9);
  EXPECT_NEAR(r.rms, 0, 1e-9);
  EXPECT_GT(fitLandmarks(pairsOf(kTorso, 1.1), MapKind::rigid).rms, 5);
}

TEST(FitLandmarks, AffineOnFourHidesEveryError) {
  auto pairs = pairsOf(kTorso, 1);
  pairs[0].moving += {10, -8, 6};
  EXPECT_NEAR(fitLandmarks(pairs, MapKind::affine).rms, 0, 1e-8);
  const Registration rigid = fitLandmarks(pairs, MapKind::rigid);
  EXPECT_GT(rigid.rms, 2);
  // Leaving the bad one out tells how bad it is.
  EXPECT_NEAR(rigid.residuals[0].leaveOneOut, std::sqrt(200.0), 1e-6);
  EXPECT_TRUE(std::isnan(fitLandmarks(pairs, MapKind::affine).residuals[0].leaveOneOut));
}

TEST(FitLandmarks, NeverMirrors) {
  std::vector<LandmarkPair> pairs = pairsOf(kTorso, 1);
  for (LandmarkPair& p : pairs) p.moving.x = -p.moving.x;
  const Registration r = fitLandmarks(pairs, MapKind::rigid);
  EXPECT_NEAR(r.scale, 1, 1e-9);
  EXPECT_GT(r.rms, 1);
}

TEST(FitLandmarks, RigidErrorWithThreeMillimetresOfNoiseIsAsPublished) {
  // Surface error of about 4.5 mm RMS by Monte Carlo for 3 mm per axis on both sides; here at the pit.
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 3);
  double squares = 0;
  const int draws = 2000;
  for (int i = 0; i < draws; ++i) {
    auto pairs = pairsOf(kTorso, 1);
    for (LandmarkPair& p : pairs)
      for (int a = 0; a < 3; ++a) p.moving[a] += noise(random), p.fixed[a] += noise(random);
    const Vec3 pit{0, -85, -150};
    const double error = distance(fitLandmarks(pairs, MapKind::rigid).map(transformed(pit, 1)), pit);
    squares += error * error;
  }
  EXPECT_GT(std::sqrt(squares / draws), 3);
  EXPECT_LT(std::sqrt(squares / draws), 6);
}

TEST(FitLandmarks, RefusesTooFewCollinearAndCoplanarLandmarks) {
  auto pairs = pairsOf(kTorso, 1);
  EXPECT_THROW(fitLandmarks({pairs[0], pairs[1]}, MapKind::rigid), Error);
  EXPECT_THROW(fitLandmarks({pairs[0], pairs[1], pairs[2]}, MapKind::affine), Error);
  EXPECT_THROW(fitLandmarks(pairsOf({{0, 0, 0}, {1, 0, 0}, {200, 0, 0}}, 1), MapKind::rigid), Error);
  EXPECT_THROW(fitLandmarks(pairsOf({{0, 0, 0}, {100, 0, 0}, {0, 0, 200}, {50, 0, 70}}, 1), MapKind::affine), Error);
  EXPECT_NO_THROW(fitLandmarks(pairsOf({{0, 0, 0}, {100, 0, 0}, {0, 0, 200}, {50, 0, 70}}, 1), MapKind::rigid));
  pairs[1].fixed.x = NAN;
  EXPECT_THROW(fitLandmarks(pairs, MapKind::rigid), Error);
}

TEST(PairLandmarks, MatchesByName) {
  Landmarks moving, fixed;
  moving.points = {{"navel", {1, 0, 0}}, {"neck", {2, 0, 0}}, {"ear", {3, 0, 0}}};
  fixed.points = {{"neck", {5, 0, 0}}, {"navel", {6, 0, 0}}, {"knee", {7, 0, 0}}};
  const auto pairs = pairLandmarks(moving, fixed);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].name, "neck");
  EXPECT_EQ(pairs[0].moving.x, 2);
}
