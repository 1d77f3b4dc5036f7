#include "plugins/scan/file/read_surface.h"

#include "kernel/stage/error.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

using namespace pectora;
namespace fs = std::filesystem;

namespace {

RawSurface readFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return readSurface(text.str(), path);
}

}  // namespace

TEST(RealFiles, GenuineFastScanTextIsRead) {
  const std::string path = std::string(PECTORA_DATA) + "/scan/fastscan_real_output_mne/test_hsp.txt";
  if (!fs::exists(path)) GTEST_SKIP() << "PECTORA_DATA is absent: " << path;
  const RawSurface s = readFile(path);
  EXPECT_EQ(s.points.size(), 500u);
  EXPECT_EQ(s.points.front(), (Vec3{-106.93, 99.80, 68.81}));
}

TEST(RealFiles, EveryMeshLoadsOrIsRefusedWithASentence) {
  const std::string folder = std::string(PECTORA_DATA);
  if (!fs::exists(folder + "/mesh")) GTEST_SKIP() << "PECTORA_DATA is absent: " << folder;
  int loaded = 0;
  std::vector<std::string> refused;
  for (const char* part : {"/mesh", "/surface", "/scan", "/registration"}) {
    for (const auto& entry : fs::recursive_directory_iterator(folder + part)) {
      std::string ending = entry.path().extension().string();
      std::transform(ending.begin(), ending.end(), ending.begin(), ::tolower);
      if (ending != ".ply" && ending != ".stl" && ending != ".obj" && ending != ".xyz" && ending != ".vtk") continue;
      try {
        const RawSurface s = readFile(entry.path().string());
        ++loaded;
        for (const Vec3& p : s.points) ASSERT_TRUE(isFinite(p)) << entry.path();
        for (const auto& t : s.triangles)
          for (int corner : t) ASSERT_LT(std::size_t(corner), s.points.size()) << entry.path();
      } catch (const Error& error) {
        EXPECT_GT(std::string(error.what()).size(), 15u);
        refused.push_back(entry.path().filename().string());
      }
    }
  }
  EXPECT_GE(loaded, 35);
  EXPECT_EQ(refused, std::vector<std::string>{"empty.stl"});  // a solid without facets
}

TEST(RealFiles, AThoraxHasTheSizeThatAnotherReaderFound) {
  const std::string path = std::string(PECTORA_DATA) + "/surface/iphone_thorax/thorax_surface_mm.ply";
  if (!fs::exists(path)) GTEST_SKIP() << "PECTORA_DATA is absent: " << path;
  const RawSurface s = readFile(path);
  EXPECT_EQ(s.points.size(), 4548u);
  EXPECT_EQ(s.triangles.size(), 9092u);
  double volume = 0, area = 0;
  for (const auto& t : s.triangles) {
    const Vec3 a = s.points[t[0]], b = s.points[t[1]], c = s.points[t[2]];
    volume += dot(a, cross(b, c)) / 6;
    area += norm(cross(b - a, c - a)) / 2;
  }
  // ORACLE.json beside the file, to the figures of a float.
  EXPECT_NEAR(volume, 8295042.847, 1);
  EXPECT_NEAR(area, 315729.812, 0.05);
}

TEST(RealFiles, TheUnitCubeHasVolumeOne) {
  const std::string path = std::string(PECTORA_DATA) + "/mesh/unit_cube.STL";
  if (!fs::exists(path)) GTEST_SKIP() << "PECTORA_DATA is absent: " << path;
  const RawSurface s = readFile(path);
  EXPECT_EQ(s.points.size(), 8u);
  double volume = 0;
  for (const auto& t : s.triangles) volume += dot(s.points[t[0]], cross(s.points[t[1]], s.points[t[2]])) / 6;
  EXPECT_NEAR(volume, 1, 1e-6);
}
