// Real surfaces, brought out of place by a known map.
#include "plugins/register/icp/icp.h"
#include "plugins/scan/file/read_surface.h"
#include "tests/bench/surfaces/chest_fields.h"

#include "kernel/stage/error.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
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
  Mesh scan = load(folder + "/Static_FB.ply");
  // The camera looked down on the stairs from about a metre; by eye, within some mm.
  for (Vec3& p : scan.points) p = {p.y + 31, p.x, 1075 - p.z};
  const Registration r = alignSurface({scan.points, {}}, drawing, nullptr, {}, [](double) {});
  std::printf("staircase: %.3f mm RMS\n", r.rms);
  // The scanner's error, as its makers give it, is some tenths of a millimetre.
  EXPECT_LT(r.rms, 0.5);
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
