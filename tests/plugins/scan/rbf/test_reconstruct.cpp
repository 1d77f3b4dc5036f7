// Surfaces whose shape is known from noisy points with holes.
#include "plugins/scan/common/normals.h"
#include "plugins/scan/rbf/reconstruct.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

using namespace pectora;

namespace {

const auto kNoPoll = [](double) {};

// Points evenly on a sphere about the origin, with noise along the normal.
std::vector<Vec3> sphere(int count, double radius, double noise, unsigned seed = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<Vec3> points;
  while (int(points.size()) < count) {
    const double x = normal(random), y = normal(random), z = normal(random);
    points.push_back(normalized({x, y, z}) * (radius + noise * normal(random)));
  }
  return points;
}

double rmsOnSphere(const Mesh& mesh, double radius) {
  double squares = 0;
  for (const Vec3& p : mesh.points) squares += std::pow(norm(p) - radius, 2);
  return std::sqrt(squares / double(mesh.points.size()));
}

int borderEdges(const Mesh& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
  int open = 0;
  for (const auto& [edge, faces] : edges) open += faces == 1;
  return open;
}

double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) sum += dot(mesh.points[t[0]], cross(mesh.points[t[1]], mesh.points[t[2]])) / 6;
  return sum;
}

}  // namespace

TEST(Normals, OfASpherePointOutwards) {
  const auto points = sphere(5000, 80, 0.3);
  const CloudNormals found = estimateNormals(points, Neighbours(points));
  int outwards = 0;
  double worst = 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    outwards += dot(found.normals[i], points[i]) > 0;
    worst = std::min(worst, dot(found.normals[i], normalized(points[i])));
  }
  EXPECT_EQ(outwards, 5000);
  EXPECT_GT(worst, 0.9);
  EXPECT_NEAR(found.noise, 0.3, 0.1);
}

TEST(Reconstruct, ClosesASphereBelowItsNoise) {
  ReconstructSettings settings;
  settings.cell = 4;
  const Reconstruction made = reconstruct(sphere(20000, 80, 0.4), {}, settings, kNoPoll);
  EXPECT_EQ(borderEdges(made.mesh), 0);
  EXPECT_LT(rmsOnSphere(made.mesh, 80), 0.4);
  EXPECT_NEAR(volume(made.mesh), 4.0 / 3 * M_PI * 80 * 80 * 80, 0.01 * 4.0 / 3 * M_PI * 80 * 80 * 80);
}

TEST(Reconstruct, FillsHolesWithinTheStatedDistanceAndLeavesOthersOpen) {
  // A hole of 8 mm radius around +z, one of 30 mm around -z.
  auto points = sphere(20000, 80, 0.2);
  std::erase_if(points, [](Vec3 p) { return std::hypot(p.x, p.y) < (p.z > 0 ? 8 : 30); });
  ReconstructSettings settings;
  settings.cell = 4;
  settings.fill = 10;
  const Mesh mesh = reconstruct(points, {}, settings, kNoPoll).mesh;
  bool coversSmall = false;
  double lowest = 1e9;
  for (const Vec3& p : mesh.points) {
    if (p.z > 0 && std::hypot(p.x, p.y) < 3) {
      coversSmall = true;
      EXPECT_NEAR(norm(p), 80, 0.5);
    }
    if (p.z < 0) lowest = std::min(lowest, std::hypot(p.x, p.y));
  }
  EXPECT_TRUE(coversSmall);
  EXPECT_GT(lowest, 24);   // drawn back to where points are
  EXPECT_GT(borderEdges(mesh), 10);
}

TEST(Reconstruct, IsTheSameForAnyNumberOfThreads) {
  const auto points = sphere(3000, 80, 0.2);
  ReconstructSettings settings;
  settings.cell = 6;
  const int before = threads();
  std::vector<Mesh> meshes;
  for (int count : {1, 3}) {
    setThreads(count);
    meshes.push_back(reconstruct(points, {}, settings, kNoPoll).mesh);
  }
  setThreads(before);
  EXPECT_EQ(meshes[0].points, meshes[1].points);
  EXPECT_EQ(meshes[0].triangles, meshes[1].triangles);
}

TEST(Reconstruct, RefusesWhatIsNoCloud) {
  EXPECT_THROW(reconstruct({}, {}, {}, kNoPoll), Error);
  auto points = sphere(500, 80, 0);
  points[3].y = NAN;
  EXPECT_THROW(reconstruct(points, {}, {}, kNoPoll), Error);
  points[3].y = 1e30;
  EXPECT_THROW(reconstruct(points, {}, {}, kNoPoll), Error);
}
