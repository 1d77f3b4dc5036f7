// Clouds that other people's scanners made.
#include "plugins/common/surface/surface_tree.h"
#include "plugins/scan/file/read_surface.h"
#include "plugins/scan/rbf/reconstruct.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

using namespace pectora;
namespace fs = std::filesystem;

namespace {

const auto kNoPoll = [](double) {};

RawSurface readFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return readSurface(text.str(), path);
}

double rms(const std::vector<SurfaceHit>& hits) {
  double squares = 0;
  std::size_t count = 0;
  for (const SurfaceHit& hit : hits)
    if (!hit.onBorder) squares += hit.distance * hit.distance, ++count;
  return std::sqrt(squares / double(count));
}

}  // namespace

TEST(ReconstructRealClouds, ComesWithinTheNoiseOfAThoraxThatWasScanned) {
  const std::string path = std::string(PECTORA_DATA) + "/surface/iphone_thorax/thorax_surface_mm.ply";
  if (!fs::exists(path)) GTEST_SKIP() << "PECTORA_DATA is absent: " << path;
  RawSurface raw = readFile(path);
  Mesh truth;
  truth.points = std::move(raw.points);
  truth.triangles = std::move(raw.triangles);
  // Points all over its wall, without the flat caps at z = -90 and 80, with a scanner's noise and a hole of 12 mm over the front.
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> noise(0, 0.6);
  std::vector<Vec3> points;
  Vec3 hole;
  for (const Vec3& p : truth.points)
    if (std::abs(p.z) < 5 && p.y < hole.y) hole = p;
  while (points.size() < 40000) {
    const auto& t = truth.triangles[random() % truth.triangles.size()];
    double u = unit(random), v = unit(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3 a = truth.points[t[0]], b = truth.points[t[1]], c = truth.points[t[2]], p = a + (b - a) * u + (c - a) * v;
    if (std::abs(normalized(cross(b - a, c - a)).z) > 0.9 || distance(p, hole) < 6) continue;
    points.push_back(p + normalized(cross(b - a, c - a)) * noise(random));
  }
  const Reconstruction made = reconstruct(points, {}, {}, kNoPoll);
  const double error = rms(SurfaceTree(truth).closest(made.mesh.points, kNoPoll));
  std::printf("thorax: noise %.2f mm found for 0.60, surface %.3f mm RMS off, %zu triangles\n", made.noise, error, made.mesh.triangles.size());
  EXPECT_NEAR(made.noise, 0.6, 0.2);
  EXPECT_LT(error, 0.6);
  EXPECT_LT(std::abs(SurfaceTree(made.mesh).closest(hole).distance), 1.5);   // filled
}

TEST(ReconstructRealClouds, FollowsTheScanOfAMachinedStaircase) {
  const std::string path = std::string(PECTORA_DATA) + "/surface/staircase_scan_vs_cad/Static_FB.ply";
  if (!fs::exists(path)) GTEST_SKIP() << "PECTORA_DATA is absent: " << path;
  const std::vector<Vec3> points = readFile(path).points;
  ASSERT_GT(points.size(), 60000u);
  ReconstructSettings settings;
  settings.cell = 1;
  settings.fill = 3;
  const Reconstruction made = reconstruct(points, {}, settings, kNoPoll);
  const double off = rms(SurfaceTree(made.mesh).closest(points, kNoPoll));
  std::printf("staircase: spacing %.2f mm, noise %.3f mm, points %.3f mm RMS off the surface, %zu triangles\n", made.spacing, made.noise, off, made.mesh.triangles.size());
  // Its steps' edges are rounded off by half a cell.
  EXPECT_LT(off, 0.5 * settings.cell);
}

TEST(ReconstructRealClouds, ClosesAHeadFromFiveHundredPointsOfFastScan) {
  const std::string path = std::string(PECTORA_DATA) + "/scan/fastscan_real_output_mne/test_hsp.txt";
  if (!fs::exists(path)) GTEST_SKIP() << "PECTORA_DATA is absent: " << path;
  const std::vector<Vec3> points = readFile(path).points;
  ReconstructSettings settings;
  settings.cell = 5;
  settings.fill = 30;
  const Reconstruction made = reconstruct(points, {}, settings, kNoPoll);
  const double off = rms(SurfaceTree(made.mesh).closest(points, kNoPoll));
  std::printf("head: spacing %.2f mm, noise %.2f mm, points %.2f mm RMS off the surface, %zu triangles\n", made.spacing, made.noise, off, made.mesh.triangles.size());
  // Hand-picked points on hair: the surface keeps about as far from them as they are rough.
  EXPECT_LT(off, 2 * made.noise);
}
