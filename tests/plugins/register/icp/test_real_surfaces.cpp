// Real surfaces, brought out of place by a known map.
#include "plugins/register/icp/icp.h"
#include "plugins/register/landmarks/fit.h"
#include "plugins/scan/file/read_surface.h"
#include "plugins/scan/rbf/reconstruct.h"
#include "tests/bench/surfaces/chest_fields.h"

#include "kernel/stage/error.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

using namespace pectora;
namespace fs = std::filesystem;

namespace {

Mesh load(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  RawSurface raw = readSurface(text.str(), path.string());
  Mesh mesh;
  mesh.points = std::move(raw.points);
  mesh.triangles = std::move(raw.triangles);
  return mesh;
}

// A turn of 2 degrees about the middle and a shift of 3.7 mm.
Vec3 outOfPlace(Vec3 p, Vec3 middle) {
  const double angle = 2 * M_PI / 180;
  const Vec3 axis = normalized({1, -2, 0.5}), d = p - middle;
  return middle + d * std::cos(angle) + cross(axis, d) * std::sin(angle) + axis * (dot(axis, d) * (1 - std::cos(angle))) + Vec3{2, -3, 1};
}

// A cloud in PCL's text format, metres, as mm.
std::vector<Vec3> loadPcd(const fs::path& path) {
  std::ifstream file(path);
  std::vector<Vec3> points;
  bool isData = false;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    Vec3 p;
    if (isData && words >> p.x >> p.y >> p.z) points.push_back(p * 1000);
    isData = isData || line.starts_with("DATA ascii");
  }
  return points;
}

}  // namespace

TEST(IcpOnRealSurfaces, FindsThemselvesAgain) {
  for (const char* name : {"/surface/iphone_thorax/thorax_surface_mm.ply", "/surface/staircase_scan_vs_cad/Staircase_CAD.ply"}) {
    const std::string path = std::string(PECTORA_DATA) + name;
    if (!fs::exists(path)) GTEST_SKIP() << "PECTORA_DATA is absent: " << path;
    const Mesh fixed = load(path);
    Vec3 middle;
    for (const Vec3& p : fixed.points) middle += p / double(fixed.points.size());
    std::vector<Vec3> moved;
    for (const Vec3& p : fixed.points) moved.push_back(outOfPlace(p, middle));
    const Registration r = alignSurface({moved, {}}, fixed, nullptr, {}, [](double) {});
    double squares = 0;
    for (std::size_t i = 0; i < moved.size(); ++i) squares += std::pow(distance(r.map(moved[i]), fixed.points[i]), 2);
    EXPECT_LT(std::sqrt(squares / double(moved.size())), 0.05) << name;
  }
}

TEST(IcpOnRealSurfaces, LaysAScannedStaircaseOnItsDrawing) {
  const std::string folder = std::string(PECTORA_DATA) + "/surface/staircase_scan_vs_cad";
  if (!fs::exists(folder)) GTEST_SKIP() << "PECTORA_DATA is absent: " << folder;
  const Mesh drawing = load(folder + "/Staircase_CAD.stl");
  for (const char* name : {"Static_FB", "Static_FB_sharp", "Static_FB_smooth_0", "Static_FB_smooth_4"}) {
    Mesh scan = load(folder + "/" + name + ".ply");
    // The camera looked down on the stairs from about a metre; by eye, within some mm.
    for (Vec3& p : scan.points) p = {p.y + 31, p.x, 1075 - p.z};
    const Registration r = alignSurface({scan.points, {}}, drawing, nullptr, {}, [](double) {});
    std::printf("%s: %.3f mm RMS\n", name, r.rms);
    // The scanner's error, as its makers give it, is some tenths of a millimetre.
    EXPECT_LT(r.rms, 0.5) << name;
  }
}

TEST(IcpOnRealSurfaces, FindsTheTurnOfTheBunnyOfCpd) {
  const std::string folder = std::string(PECTORA_DATA) + "/registration/pycpd";
  if (!fs::exists(folder)) GTEST_SKIP() << "PECTORA_DATA is absent: " << folder;
  // 453 points each, in a unit of their own: 100 make a bunny of 150 mm.
  Mesh source = load(folder + "/bunny_source.txt"), target = load(folder + "/bunny_target.txt");
  for (Mesh* m : {&source, &target})
    for (Vec3& p : m->points) p *= 100;
  std::vector<LandmarkPair> pairs;
  for (std::size_t i = 0; i < source.points.size(); ++i) pairs.push_back({std::to_string(i), source.points[i], target.points[i]});
  const AffineMap truth = fitLandmarks(pairs, MapKind::rigid).map;
  // Four landmarks, 3 mm off in every direction, and then the surface itself.
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 3);
  std::vector<LandmarkPair> four;
  for (std::size_t i : {0, 120, 240, 360}) {
    four.push_back(pairs[i]);
    for (int a = 0; a < 3; ++a) four.back().moving[a] += noise(random);
  }
  const AffineMap start = fitLandmarks(four, MapKind::rigid).map;
  std::vector<Vec3> placed;
  for (const Vec3& p : source.points) placed.push_back(start(p));
  const Mesh surface = reconstruct(target.points, {}, {.noise = 0.1, .cell = 3, .fill = 15}, [](double) {}).mesh;
  const Registration r = alignSurface({placed, {}}, surface, nullptr, {}, [](double) {});
  double before = 0, after = 0;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    before += std::pow(distance(placed[i], target.points[i]), 2) / double(placed.size());
    after += std::pow(distance(r.map(placed[i]), truth(source.points[i])), 2) / double(placed.size());
  }
  std::printf("bunny of CPD: %.2f mm RMS off by landmarks, %.3f by the surface\n", std::sqrt(before), std::sqrt(after));
  EXPECT_GT(std::sqrt(before), 1);
  // The points are 8 mm apart: a surface between them is known to a tenth of that.
  EXPECT_LT(std::sqrt(after), 0.8);
}

TEST(IcpOnRealSurfaces, FindsTheTurnBetweenTwoScansOfTheBunny) {
  const std::string folder = std::string(PECTORA_DATA) + "/registration/pcl";
  if (!fs::exists(folder)) GTEST_SKIP() << "PECTORA_DATA is absent: " << folder;
  // Two scans of some 400 points, 7 mm apart, that see each other's surface in part; from where the scanner left them.
  const std::vector<Vec3> source = loadPcd(folder + "/bun0.pcd"), target = loadPcd(folder + "/bun4.pcd");
  const Mesh surface = reconstruct(target, {}, {.noise = 0, .cell = 2, .fill = 8}, [](double) {}).mesh;
  const Registration r = alignSurface({source, {}}, surface, nullptr, {}, [](double) {});
  // The turn between bun000 and bun045 in the file bun.conf of the Stanford 3D Scanning Repository, as a quaternion.
  const Vec3 turn{0.00548449, -0.294635, -0.0038555};
  const double angle = 2 * std::acos(0.955586);
  const auto& m = r.map.linear;
  const Vec3 found{m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]};   // axis times 2 sin of the angle
  const double foundAngle = std::acos((m[0][0] + m[1][1] + m[2][2] - 1) / 2);
  std::printf("bunny: turned by %.2f degrees, %.2f in the repository\n", foundAngle * 180 / M_PI, angle * 180 / M_PI);
  // An error of 1 mm over the bunny's 80 mm is 0.7 degrees.
  EXPECT_NEAR(foundAngle * 180 / M_PI, angle * 180 / M_PI, 0.7);
  EXPECT_GT(dot(normalized(found), normalized(turn)), std::cos(2 * M_PI / 180));
}

TEST(IcpOnRealSurfaces, MeasuresOrRefusesEveryMesh) {
  const std::string folder = std::string(PECTORA_DATA) + "/mesh";
  if (!fs::exists(folder)) GTEST_SKIP() << "PECTORA_DATA is absent: " << folder;
  int measured = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    try {
      const Mesh mesh = load(entry.path());
      const SurfaceTree tree(mesh);
      ++measured;
      // A corner of a triangle lies on the surface, a point far away has a finite distance.
      for (std::size_t i = 0; i < mesh.triangles.size(); i += 1 + mesh.triangles.size() / 50)
        EXPECT_LT(std::abs(tree.closest(mesh.points[mesh.triangles[i][0]]).distance), 1e-9) << entry.path();
      EXPECT_TRUE(std::isfinite(tree.closest({1e4, -1e4, 1e4}).distance)) << entry.path();
    } catch (const Error& error) {
      EXPECT_GT(std::string(error.what()).size(), 15u) << entry.path();
    }
  }
  EXPECT_GT(measured, 10);
}
