#include "plugins/report/files/surface_picture.h"

#include <gtest/gtest.h>

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
