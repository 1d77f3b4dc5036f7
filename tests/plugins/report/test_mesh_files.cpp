#include "plugins/report/common/atomic_file.h"
#include "plugins/report/common/mesh_files.h"
#include "plugins/scan/file/read_surface.h"

#include "kernel/stage/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <regex>

using namespace pectora;

namespace {

Mesh triangle() {
  Mesh m;
  m.points = {{0, 0, 0}, {10, 0, 0}, {0, 10, 5}};
  m.triangles = {{0, 1, 2}};
  m.fields = {{"distance", "mm", {1, -2, 3}}};
  return m;
}

// The float at a position of the appended data of a VTP file.
float appendedFloat(const std::string& bytes, std::size_t offset, int index) {
  const std::size_t data = bytes.find("\n_") + 2 + offset + 4;
  float value;
  std::memcpy(&value, bytes.data() + data + 4 * index, 4);
  return value;
}

}  // namespace

TEST(PlyFile, IsReadBackByOurOwnReader) {
  const RawSurface s = readPly(plyBytes(triangle(), {"key"}));
  ASSERT_EQ(s.points.size(), 3u);
  EXPECT_EQ(s.points[2], (Vec3{0, 10, 5}));
  EXPECT_EQ(s.triangles[0], (std::array<int, 3>{0, 1, 2}));
}

TEST(PlyFile, HoldsTheFieldsAsPropertiesOfTheVerticesWithTheirUnit) {
  Points points;
  points.points = {{1, 2, 3}, {4, 5, 6}};
  points.normals = {{0, 0, 1}, {0, 1, 0}};
  points.fields = {{"distance", "mm", {-0.5, std::nan("")}}, {"pit", "", {1, 0}}};
  const std::string bytes = plyBytes(points, {"key"});
  EXPECT_NE(bytes.find("comment distance is in mm\n"), std::string::npos);
  EXPECT_NE(bytes.find("property float nz\nproperty float distance\nproperty float pit\nend_header\n"), std::string::npos);
  float values[16];
  ASSERT_EQ(bytes.size() - bytes.find("end_header\n") - 11, sizeof values);
  std::memcpy(values, bytes.data() + bytes.size() - sizeof values, sizeof values);
  EXPECT_EQ(values[6], -0.5f);
  EXPECT_EQ(values[7], 1);
  EXPECT_EQ(values[8], 4);
  EXPECT_TRUE(std::isnan(values[14]));
  EXPECT_EQ(values[15], 0);
}

TEST(PlyFile, CarriesItsRecord) { EXPECT_NE(plyBytes(triangle(), {"0123abcd"}).find("pectora record 0123abcd"), std::string::npos); }

TEST(VtpFile, HoldsPointsCellsAndTheFieldAtItsOffsets) {
  const std::string bytes = vtpBytes(triangle(), {"key"});
  EXPECT_NE(bytes.find("NumberOfPoints=\"3\""), std::string::npos);
  EXPECT_NE(bytes.find("NumberOfPolys=\"1\""), std::string::npos);
  std::smatch match;
  ASSERT_TRUE(std::regex_search(bytes, match, std::regex("Name=\"distance \\[mm\\]\" format=\"appended\" offset=\"(\\d+)\"")));
  const std::size_t offset = std::stoul(match[1]);
  EXPECT_EQ(appendedFloat(bytes, offset, 0), 1);
  EXPECT_EQ(appendedFloat(bytes, offset, 1), -2);
  EXPECT_EQ(appendedFloat(bytes, 0, 8), 5);
}

TEST(BarMesh, IsClosedAndFacesOutwards) {
  const Bar low{.centerline = {{-50, 0, 0}, {0, -10, 0}, {50, 0, 0}}};
  Bar oblique{.centerline = {{-50, 0, 10}, {0, -10, 60}, {50, 0, 110}}};
  oblique.up = normalized({-1, 0, 1});
  const Mesh bar = barMesh({low, oblique});
  double volume = 0;
  for (const auto& t : bar.triangles) volume += dot(bar.points[t[0]], cross(bar.points[t[1]], bar.points[t[2]])) / 6;
  // The sections at the ends stand across the chord between two points: the length is right to a part of the kink.
  EXPECT_NEAR(volume, 12.7 * 3.5 * 2 * (std::hypot(50, 10) + std::hypot(50, 50, 10)), 300);
}

TEST(WriteFile, LeavesNoHalfFileBehind) {
  const std::string folder = testing::TempDir() + "/pectora_report/deep";
  std::filesystem::remove_all(folder);
  writeFile(folder + "/a.txt", "hello");
  std::ifstream file(folder + "/a.txt");
  std::string text;
  file >> text;
  EXPECT_EQ(text, "hello");
  EXPECT_FALSE(std::filesystem::exists(asideName(folder + "/a.txt")));
  EXPECT_THROW(writeFile("/proc/nowhere/a.txt", "x"), Error);
}
