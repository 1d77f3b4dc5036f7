#include "kernel/value/levels.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pectora;

namespace {

Vec3 turned(double x, double y, double degrees) {
  const double a = degrees * M_PI / 180;
  return {std::cos(a) * x - std::sin(a) * y, std::sin(a) * x + std::cos(a) * y, 0};
}

// The front of an ellipse with half axes 150 x 100 about (0, 0), with a box cut out of it 40 mm wide down to y = -80.
std::vector<Vec3> boxedEllipse() {
  std::vector<Vec3> line;
  for (int x = -150; x <= 150; ++x) {
    const double y = -100 * std::sqrt(1 - x * x / 22500.0);
    if (std::abs(x) == 20) line.push_back({double(x), x < 0 ? y : -80, 0}), line.push_back({double(x), x < 0 ? -80 : y, 0});
    else line.push_back({double(x), std::abs(x) < 20 ? -80 : y, 0});
  }
  return line;
}

double fact(const LevelMetrics& level, const std::string& name) {
  for (const Fact& f : levelFacts(level))
    if (f.name == name) return std::get<double>(f.value);
  ADD_FAILURE() << name;
  return NAN;
}

}  // namespace

TEST(MeasureLevel, GivesHallersLengthsOfAnEllipseWithASternum) {
  // Inner wall: half axes 120 x 80 about (0, 0), the vertebra's front at y = 60, the sternum a bar at y = -30 to -20.
  std::vector<Vec3> wall;
  for (int d = -120; d <= 120; ++d) wall.push_back({120 * std::sin(d * M_PI / 180), -80 * std::cos(d * M_PI / 180), 5});
  const std::vector<Vec3> sternum{{-20, -30, 5}, {20, -30, 5}, {20, -20, 5}, {-20, -20, 5}};
  const LevelMetrics m = measureLevel(5, sternum, {0, 60, 5}, wall, 0);
  EXPECT_NEAR(m.transverse, 240, 0.05);
  EXPECT_NEAR(m.sternumToVertebra, 80, 1e-9);
  EXPECT_NEAR(m.deepestInnerWall, 140, 1e-9);
  EXPECT_NEAR(m.haller(), 3, 1e-3);
  EXPECT_NEAR(m.correctionIndex(), 100 * 60.0 / 140, 1e-6);
  EXPECT_NEAR(fact(m, "depression"), 60, 1e-9);
  EXPECT_NEAR(fact(m, "depression_index"), 140.0 / 80, 1e-9);
  EXPECT_NEAR(fact(m, "asymmetry"), 1, 1e-3);
  EXPECT_NEAR(fact(m, "flatness"), 240.0 / 140, 1e-3);
  EXPECT_NEAR(fact(m, "torsion"), 0, 1e-9);
}

TEST(MeasureLevel, TellsTheTwoHalvesApart) {
  // The right half reaches 60 mm forward, the left one 40; the sternum is deepest 15 mm to the left.
  const std::vector<Vec3> wall{{-100, 0, 0}, {-50, -60, 0}, {0, -30, 0}, {50, -40, 0}, {100, 0, 0}};
  const LevelMetrics m = measureLevel(0, std::vector<Vec3>{{-15, -30, 0}, {15, -24, 0}, {15, -34, 0}, {-15, -40, 0}}, {0, 0, 0}, wall, 0);
  EXPECT_NEAR(fact(m, "asymmetry"), 1.5, 1e-9);
  EXPECT_NEAR(fact(m, "eccentricity"), 15, 1e-9);
  EXPECT_NEAR(fact(m, "flatness"), 200.0 / 60, 1e-9);
  EXPECT_NEAR(m.torsionDeg, std::atan(6.0 / 30) * 180 / M_PI, 1e-6);
}

TEST(MeasureLevel, IsInTheAxesOfATurnedPatient) {
  const std::vector<Vec3> wall{turned(-100, 0, 20), turned(-60, -60, 20), turned(60, -60, 20), turned(100, 0, 20)};
  const std::vector<Vec3> sternum{turned(-10, -55, 20), turned(10, -55, 20), turned(10, -50, 20), turned(-10, -50, 20)};
  const LevelMetrics m = measureLevel(0, sternum, {0, 0, 0}, wall, 20);
  EXPECT_NEAR(m.transverse, 200, 1e-9);
  EXPECT_NEAR(m.sternumToVertebra, 50, 1e-9);
  EXPECT_NEAR(m.deepestInnerWall, 60, 1e-9);
}

TEST(MeasureLevel, LeavesUnknownLengthsZeroAndTheirIndicesNoNumbers) {
  const LevelMetrics m = measureLevel(0, {}, {0, 0, 0}, {}, 0);
  EXPECT_EQ(m.transverse, 0);
  EXPECT_EQ(m.sternumToVertebra, 0);
  EXPECT_EQ(m.deepestInnerWall, 0);
  for (const Fact& f : levelFacts(m)) EXPECT_TRUE(std::isnan(std::get<double>(f.value))) << f.name;
}

TEST(SectionTorsion, IsTheSlopeAlsoOfASquareThatHasNoLongAxis) {
  // As deep as wide, as an axial slice cuts a steep sternum; every column is shifted by 0.3 of its x.
  std::vector<Vec3> square;
  for (const auto& [x, y] : {std::pair{-15.0, -15.0}, {15.0, -15.0}, {15.0, 15.0}, {-15.0, 15.0}}) square.push_back({x, y + 0.3 * x, 0});
  EXPECT_NEAR(sectionTorsion(square), std::atan(0.3) * 180 / M_PI, 1e-6);
}

TEST(MeasureSkin, GivesTheIndicesOfAnEllipseWithABoxCutOut) {
  LevelMetrics level;
  measureSkin(level, boxedEllipse(), {0, 0, 0}, 0, 300, 90);
  const double summit = 100 * std::sqrt(1 - 400 / 22500.0);
  EXPECT_NEAR(level.externalPit, 170, 1e-9);
  EXPECT_NEAR(level.externalFront, 90 + summit, 1e-9);
  EXPECT_NEAR(fact(level, "external_haller_index"), 300.0 / 170, 1e-9);
  EXPECT_NEAR(fact(level, "external_correction_index"), 100 * (summit - 80) / (90 + summit), 1e-9);
  EXPECT_NEAR(level.concavityArea, 40 * (summit - 80), 1e-9) << "the hull runs straight from edge to edge of the box";
}

TEST(MeasureSkin, FindsNoConcavityInAnEllipse) {
  std::vector<Vec3> line;
  for (int d = -90; d <= 90; ++d) line.push_back({150 * std::sin(d * M_PI / 180), -100 * std::cos(d * M_PI / 180), 0});
  LevelMetrics level;
  measureSkin(level, line, {0, 0, 0}, 0, 300, 90);
  EXPECT_NEAR(level.concavityArea, 0, 1e-9);
  EXPECT_NEAR(level.externalCorrectionIndex(), 0, 0.1);
}

TEST(ConcavityVolume, OfABoxIsItsVolume) {
  std::vector<LevelMetrics> levels;
  for (int z = 0; z <= 100; z += 5) {
    LevelMetrics level;
    level.z = z;
    measureSkin(level, boxedEllipse(), {0, 0, 0}, 0, 300, 90);
    levels.push_back(level);
  }
  EXPECT_NEAR(concavityVolume(levels), 0.1 * 40 * (100 * std::sqrt(1 - 400 / 22500.0) - 80), 1e-9);
}

TEST(FrontAt, CutsAMeshAndBinsACloudToTheSameLine) {
  // A plane tilted across, in front of a vertebra at y = 0.
  Mesh mesh;
  Points cloud;
  for (int j = 0; j <= 20; ++j)
    for (int i = 0; i <= 50; ++i) mesh.points.push_back({4.0 * i - 100, -80 - 0.2 * (4.0 * i - 100), 5.0 * j});
  for (int j = 0; j < 20; ++j)
    for (int i = 0; i < 50; ++i) {
      const int a = 51 * j + i;
      mesh.triangles.push_back({a, a + 1, a + 52}), mesh.triangles.push_back({a, a + 52, a + 51});
    }
  for (double x = -99.5; x < 100; ++x)
    for (double z = 0; z < 100; ++z) cloud.points.push_back({x, -80 - 0.2 * x, z});
  for (const auto& line : {frontAt(mesh, 42, {0, 0, 42}, 60), frontAt(cloud, 42, {0, 0, 42}, 60)}) {
    ASSERT_GT(line.size(), 20u);
    for (const Vec3& p : line) {
      EXPECT_NEAR(p.y, -80 - 0.2 * p.x, 1e-9);
      EXPECT_LE(std::abs(p.x), 60);
    }
  }
}
