#include "plugins/report/files/metrics_table.h"
#include "plugins/report/files/solid_view.h"
#include "plugins/report/files/surface_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

using namespace pectora;

TEST(DivergingColor, IsBlueBelowGreyAtAndRedAboveZero) {
  EXPECT_GT(divergingColor(-5, 5).b, divergingColor(-5, 5).r);
  EXPECT_GT(divergingColor(5, 5).r, divergingColor(5, 5).b);
  EXPECT_NEAR(divergingColor(0, 5).r, divergingColor(0, 5).b, 0.02);
}

TEST(RoundLimit, HoldsNearlyAllValues) {
  std::vector<double> values;
  for (int i = 0; i <= 100; ++i) values.push_back(0.07 * i);
  values.push_back(NAN);
  EXPECT_EQ(roundLimit(values), 8);
  EXPECT_EQ(roundLimit({}), 1);
}

TEST(SurfacePicture, IsWrittenAsPng) {
  Mesh mesh;
  mesh.points = {{-50, -10, 0}, {50, -10, 0}, {0, -10, 80}};
  mesh.triangles = {{0, 1, 2}};
  mesh.fields = {{"distance", "mm", {-3, 0, 3}}};
  const std::string path = testing::TempDir() + "/pectora_picture.png";
  surfacePicture(mesh, "distance", 3, "A triangle", {"one line"}).write(path);
  std::ifstream file(path, std::ios::binary);
  char head[8] = {};
  file.read(head, 8);
  EXPECT_EQ(std::string(head + 1, 3), "PNG");
}

TEST(TubeMesh, IsClosedAndHasTheVolumeOfAnEllipticCylinder) {
  const Mesh tube = tubeMesh({{0, -50, 0}, {30, -50, 0}, {60, -50, 0}}, 6, 4, {30, 0, 0});
  double volume = 0;
  for (const auto& t : tube.triangles) volume += dot(tube.points[t[0]], cross(tube.points[t[1]], tube.points[t[2]])) / 6;
  // A 20-gon has 0.984 of its ellipse's area.
  EXPECT_NEAR(std::abs(volume), 0.984 * M_PI * 6 * 4 * 60, 0.002 * M_PI * 6 * 4 * 60);
}

TEST(SolidView, HidesWhatIsFartherAway) {
  Canvas canvas(60, 60, kWhite);
  SolidView view(Seen::fromFront, 0, 0, 60, 60, {0, 0, 0}, 1);
  const auto box = [](double y) {
    return stackMesh({{{-10, y, -10}, {10, y, -10}, {10, y + 5, -10}, {-10, y + 5, -10}}, {{-10, y, 10}, {10, y, 10}, {10, y + 5, 10}, {-10, y + 5, 10}}});
  };
  view.draw(box(-20), {1, 0, 0});   // nearer
  view.draw(box(20), {0, 0, 1});
  view.paint(canvas);
  const std::string path = testing::TempDir() + "/pectora_solids.png";
  canvas.write(path);
  EXPECT_NEAR(view.at({10, 0, 10})[0], 40, 1e-9);
  EXPECT_NEAR(view.at({10, 0, 10})[1], 20, 1e-9);
  const Color seen = canvas.colorAt(30, 30), beside = canvas.colorAt(5, 5);
  EXPECT_GT(seen.r, 0.3);
  EXPECT_LT(seen.b, 0.05);
  EXPECT_EQ(beside.g, 1);
}

TEST(MetricsCsv, HasARowForEveryStateAndLevelAndLeavesTheUnknownEmpty) {
  LevelMetrics known, outside;
  known.z = -100, known.transverse = 240, known.sternumToVertebra = 60, known.deepestInnerWall = 90;
  outside.z = -100, outside.externalWidth = 300, outside.externalPit = 150, outside.externalFront = 180;
  const std::string csv = metricsCsv({{"before", {known}}, {"scan", {outside}}});
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_NE(csv.find("before,-100.00,240.0000,60.0000,90.0000,4.0000,33.3333,30.0000,1.5000,,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("scan,-100.00,,,,,,,,,,,,2.0000,16.6667,0.0000"), std::string::npos) << csv;
}

TEST(MetricsJson, GivesValueUnitAndFormulaAtTheLevel) {
  LevelMetrics a, b;
  a.z = -100, a.transverse = 240, a.sternumToVertebra = 60, a.deepestInnerWall = 90;
  b.z = -50, b.transverse = 230, b.sternumToVertebra = 100, b.deepestInnerWall = 100;
  const Json json = metricsJson({{"before", {a, b}}}, -98);
  EXPECT_EQ(json["before"]["haller_index"]["value"], 4);
  EXPECT_EQ(json["before"]["haller_index"]["formula"], "T / B");
  EXPECT_EQ(json["before"]["correction_index"]["unit"], "%");
  EXPECT_FALSE(json["before"].contains("external_haller_index"));
}
