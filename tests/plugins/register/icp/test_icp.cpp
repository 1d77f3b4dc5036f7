// Alignment of chest-like surfaces whose pose is known.
#include "plugins/common/surface/point_normals.h"
#include "plugins/register/icp/icp.h"
#include "tests/bench/surfaces/chest_fields.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"
#include "kernel/stage/host.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

using namespace pectora;
using namespace pectora::bench;

namespace {

const auto kNoPoll = [](double) {};
const std::vector<Vec3> kNoNormals;

double figure(const Registration& r, const std::string& name) {
  for (const Fact& f : r.facts())
    if (f.name == name) return std::get<double>(f.value);
  ADD_FAILURE() << "no fact " << name;
  return NAN;
}
std::string word(const Registration& r, const std::string& name) {
  for (const Fact& f : r.facts())
    if (f.name == name) return std::get<std::string>(f.value);
  return "";
}

// RMS and largest distance of where the map takes displaced points from where they came.
std::pair<double, double> targetError(const AffineMap& map) {
  double squares = 0, largest = 0;
  int count = 0;
  for (double x = -120; x <= 120; x += 20)
    for (double z = -160; z <= 160; z += 20) {
      const Vec3 p = chestPoint(x, z);
      const double d = distance(map(displace(p)), p);
      squares += d * d;
      largest = std::max(largest, d);
      ++count;
    }
  return {std::sqrt(squares / count), largest};
}

void expectRigid(const AffineMap& map) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      double sum = 0;
      for (int k = 0; k < 3; ++k) sum += map.linear[r][k] * map.linear[c][k];
      EXPECT_NEAR(sum, r == c, 1e-12);
    }
}

}  // namespace

TEST(Icp, UndoesATurnOfFiveDegreesAndAShiftWithoutNoise) {
  const Mesh fixed = reference(201), moving = displaced(101, 0, 1);
  const Registration r = alignSurface({moving.points, pointNormals(moving)}, fixed, nullptr, {}, kNoPoll);
  expectRigid(r.map);
  EXPECT_EQ(word(r, "status"), "converged");
  // Triangles of 1.4 mm cut up to 0.02 mm off the pit's curve.
  EXPECT_LT(targetError(r.map).first, 0.01);
  EXPECT_LT(figure(r, "iterations"), 30);
}

TEST(Icp, AveragesNoiseAwayAndKnowsItsError) {
  const Mesh fixed = reference(401), moving = displaced(201, 0.2, 2);
  const Registration r = alignSurface({moving.points, pointNormals(moving)}, fixed, nullptr, {}, kNoPoll);
  const double error = targetError(r.map).first;
  EXPECT_LT(error, 0.03);
  EXPECT_NEAR(r.rms, 0.2, 0.03);
  EXPECT_NEAR(figure(r, "held_out_rms"), 0.2, 0.03);
  // The error is one draw of what was expected.
  EXPECT_LT(error, 4 * figure(r, "expected_error"));
  EXPECT_GT(error, figure(r, "expected_error") / 10);
  EXPECT_GT(figure(r, "condition"), 1);
  EXPECT_FALSE(word(r, "weakest_direction").empty());
}

TEST(Icp, IsNotDrawnByAPitThatWasRaised) {
  // The scan shows a chest, uneven enough to hold on to, without its pit.
  const auto healed = [](double x, double z) { return Vec3{x, 60 * (1 - x * x / (170.0 * 170)) - 15 * z * z / (180.0 * 180) + 6 * std::sin(x / 60) * std::cos(z / 70), z}; };
  const Mesh predicted = heightField(201, 140, 180, 0, 0, healed);
  const Mesh fixed = heightField(201, 140, 180, 0, 0, [&](double x, double z) { return healed(x, z) - Vec3{0, 25 * std::exp(-(x * x + z * z) / 2450), 0}; });
  const Mesh moving = heightField(101, 120, 160, 0, 0, [&](double x, double z) { return displace(healed(x, z)); });
  IcpSettings settings;
  const auto normals = pointNormals(moving);
  const auto error = [&](const AffineMap& map) {
    double worst = 0;
    for (double x : {-100., 0., 100.})
      for (double z : {-150., 0., 150.}) worst = std::max(worst, distance(map(displace(healed(x, z))), healed(x, z)));
    return worst;
  };
  const Registration masked = alignSurface({moving.points, normals}, fixed, &predicted, settings, kNoPoll);
  EXPECT_LT(error(masked.map), 0.05);
  EXPECT_GT(figure(masked, "points_in_changed_region"), 500);
  settings.ballCenter = {0, 40, 0};
  settings.ballRadius = 110;
  EXPECT_LT(error(alignSurface({moving.points, normals}, fixed, nullptr, settings, kNoPoll).map), 0.05);
}

TEST(Icp, SaysWhichDirectionTheSurfaceLeavesFree) {
  // A cylinder turns about its axis and slides along it.
  const auto cylinder = [](int n, double halfZ) {
    return heightField(n, 1.2, halfZ, 0, 0, [](double angle, double z) { return Vec3{-100 * std::sin(angle), 100 * std::cos(angle), z}; });
  };
  const Mesh fixed = cylinder(121, 150);
  Mesh moving = cylinder(61, 100);
  for (Vec3& p : moving.points) p += {0.5, 1, 0};
  const Registration r = alignSurface({moving.points, kNoNormals}, fixed, nullptr, {}, kNoPoll);
  // Facets of the mesh hold it a little, so it may count as determined, but badly.
  EXPECT_TRUE(word(r, "status") == "undetermined" || figure(r, "condition") > 50) << word(r, "status") << figure(r, "condition");
  EXPECT_NEAR(r.map({0, 100, 0}).y, 99, 0.05);
}

TEST(Icp, KeepsTheOverlapOnlyIfAsked) {
  // Half of the moving surface stands 3 mm off.
  const Mesh fixed = reference(161);
  Mesh moving = heightField(81, 120, 160, 0, 0, [](double x, double z) { return chestPoint(x, z) + (z > 20 ? Vec3{0, 3, 0} : Vec3{}); });
  IcpSettings settings;
  settings.overlap = 0.5;
  const Registration r = alignSurface({moving.points, kNoNormals}, fixed, nullptr, settings, kNoPoll);
  EXPECT_LT(distance(r.map(chestPoint(60, -100)), chestPoint(60, -100)), 0.3);
}

TEST(Icp, PassesOverPointsThatFaceTheOtherWay) {
  // A second sheet 1 mm behind, whose normals point inwards, as a scan of clothing's inside would.
  const Mesh fixed = reference(121);
  const Mesh front = heightField(61, 120, 160, 0, 0, [](double x, double z) { return chestPoint(x, z); });
  std::vector<Vec3> points = front.points, normals = pointNormals(front);
  for (std::size_t i = 0, n = front.points.size(); i < n; ++i) points.push_back(front.points[i] + Vec3{0, -1, 0}), normals.push_back(-normals[i]);
  const Registration r = alignSurface({points, normals}, fixed, nullptr, {}, kNoPoll);
  EXPECT_NEAR(figure(r, "points_with_another_normal"), 0.95 * 61 * 61, 500);
  EXPECT_LT(distance(r.map(chestPoint(0, 50)), chestPoint(0, 50)), 0.02);
}

TEST(Icp, GivesTheSameBitsForAnyNumberOfThreads) {
  const Mesh fixed = reference(101), moving = displaced(91, 0.2, 5);
  const int before = threads();
  std::vector<AffineMap> maps;
  for (int count : {1, 2, 3}) {
    setThreads(count);
    maps.push_back(alignSurface({moving.points, kNoNormals}, fixed, nullptr, {}, kNoPoll).map);
  }
  setThreads(before);
  for (const AffineMap& map : maps) {
    EXPECT_EQ(map.linear, maps[0].linear);
    EXPECT_EQ(map.translation, maps[0].translation);
  }
}

TEST(Icp, StopsWhenAskedAndSaysWhenItWasTooShort) {
  const Mesh fixed = reference(61), moving = displaced(61, 0.2, 5);
  EXPECT_THROW(alignSurface({moving.points, kNoNormals}, fixed, nullptr, {}, [](double) { throw Cancelled(); }), Cancelled);
  IcpSettings settings;
  settings.maxIterations = 2;
  EXPECT_EQ(word(alignSurface({moving.points, kNoNormals}, fixed, nullptr, settings, kNoPoll), "status"), "stopped");
}

TEST(Icp, RefusesWhatCannotBeAligned) {
  const Mesh fixed = reference(61);
  Mesh moving = displaced(31, 0, 1);
  EXPECT_THROW(alignSurface({{}, kNoNormals}, fixed, nullptr, {}, kNoPoll), Error);
  for (Vec3& p : moving.points) p += {5000, 0, 0};
  EXPECT_THROW(alignSurface({moving.points, kNoNormals}, fixed, nullptr, {}, kNoPoll), Error);
  moving.points[7].x = NAN;
  EXPECT_THROW(alignSurface({moving.points, kNoNormals}, fixed, nullptr, {}, kNoPoll), Error);
  moving.points[7].x = 1e300;
  EXPECT_THROW(alignSurface({moving.points, kNoNormals}, fixed, nullptr, {}, kNoPoll), Error);
  EXPECT_THROW(alignSurface({fixed.points, kNoNormals}, Mesh{}, nullptr, {}, kNoPoll), Error);
  const std::vector<Vec3> same(1000, Vec3{1, 2, 3});
  IcpSettings wide;
  wide.maxDistance = 200;
  const Registration free = alignSurface({same, kNoNormals}, fixed, nullptr, wide, kNoPoll);
  EXPECT_TRUE(isFinite(free.map.translation));
  EXPECT_EQ(word(free, "status"), "undetermined");
}
