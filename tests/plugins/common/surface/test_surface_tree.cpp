#include "plugins/common/surface/surface_tree.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace pectora;

namespace {

Mesh cube() {
  Mesh m;
  for (int i = 0; i < 8; ++i) m.points.push_back({i & 1 ? 1. : -1., i & 2 ? 1. : -1., i & 4 ? 1. : -1.});
  m.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return m;
}

// A wavy open sheet whose normals point to -y.
Mesh sheet(int n) {
  Mesh m;
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) m.points.push_back({double(c), 1.5 * std::sin(0.6 * c) * std::cos(0.4 * r), double(r)});
  for (int r = 0; r + 1 < n; ++r)
    for (int c = 0; c + 1 < n; ++c) {
      const int a = r * n + c;
      m.triangles.push_back({a, a + 1, a + n + 1});
      m.triangles.push_back({a, a + n + 1, a + n});
    }
  return m;
}

double bruteForce(const Mesh& mesh, Vec3 p) {
  double best = INFINITY;
  for (const auto& t : mesh.triangles) best = std::min(best, distance(p, closestOnTriangle(p, mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]).point));
  return best;
}

}  // namespace

TEST(ClosestOnTriangle, FindsEachFeature) {
  const Vec3 a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0};
  EXPECT_EQ(closestOnTriangle({-1, -1, 2}, a, b, c).feature, Feature::cornerA);
  EXPECT_EQ(closestOnTriangle({6, -1, 2}, a, b, c).feature, Feature::cornerB);
  EXPECT_EQ(closestOnTriangle({-1, 6, 2}, a, b, c).feature, Feature::cornerC);
  EXPECT_EQ(closestOnTriangle({2, -1, 2}, a, b, c).feature, Feature::edgeAB);
  EXPECT_EQ(closestOnTriangle({3, 3, 2}, a, b, c).feature, Feature::edgeBC);
  EXPECT_EQ(closestOnTriangle({-1, 2, 2}, a, b, c).feature, Feature::edgeCA);
  EXPECT_EQ(closestOnTriangle({1, 1, 2}, a, b, c).feature, Feature::face);
  EXPECT_LT(distance(closestOnTriangle({1, 1, 2}, a, b, c).point, {1, 1, 0}), 1e-15);
}

TEST(ClosestOnTriangle, SurvivesTrianglesWithoutArea) {
  for (const auto& [a, b, c] : {std::array<Vec3, 3>{Vec3{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {Vec3{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {Vec3{0, 0, 0}, {0, 0, 0}, {3, 0, 0}}}) {
    const Vec3 found = closestOnTriangle({1, 5, 0}, a, b, c).point;
    EXPECT_TRUE(isFinite(found));
    const double best = std::min({distance({1, 5, 0}, a), distance({1, 5, 0}, b), distance({1, 5, 0}, c)});
    EXPECT_LE(distance({1, 5, 0}, found), best + 1e-12);
  }
}

TEST(SurfaceTree, GivesTheDistanceOfACubeInClosedForm) {
  const SurfaceTree tree(cube());
  EXPECT_NEAR(tree.closest({3, 0, 0}).distance, 2, 1e-15);
  EXPECT_NEAR(tree.closest({2, 2, 2}).distance, std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(tree.closest({2, 2, 0}).distance, std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(tree.closest({0.5, 0, 0}).distance, -0.5, 1e-15);
  EXPECT_NEAR(tree.closest({0.9, 0.8, 0.7}).distance, -0.1, 1e-15);
  EXPECT_FALSE(tree.closest({3, 0, 0}).onBorder);
}

TEST(SurfaceTree, AgreesWithBruteForceAndNeverHasTheWrongSideOfAnOpenSheet) {
  const Mesh mesh = sheet(20);
  const SurfaceTree tree(mesh);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> along(0.5, 18.5), off(0.05, 1.2);
  for (int i = 0; i < 3000; ++i) {
    // Start on a face and leave along its normal: the side is known by construction while the face stays the nearest.
    const auto& t = mesh.triangles[random() % mesh.triangles.size()];
    const Vec3 a = mesh.points[t[0]], b = mesh.points[t[1]], c = mesh.points[t[2]];
    const Vec3 normal = normalized(cross(b - a, c - a));
    const double d = (i % 2 ? 1 : -1) * off(random);
    const Vec3 p = (a + b + c) / 3 + normal * d;
    const SurfaceHit hit = tree.closest(p);
    EXPECT_NEAR(std::abs(hit.distance), bruteForce(mesh, p), 1e-13);
    const bool faceIsNearest = std::abs(std::abs(hit.distance) - std::abs(d)) < 1e-12;
    EXPECT_TRUE(!faceIsNearest || hit.distance * d > 0);
  }
}

TEST(SurfaceTree, FlagsPointsBeyondTheBorder) {
  const SurfaceTree tree(sheet(10));
  EXPECT_TRUE(tree.closest({-3, 0, 4.5}).onBorder);
  EXPECT_TRUE(tree.closest({-3, 0, -3}).onBorder);
  EXPECT_FALSE(tree.closest({4.2, 2, 4.5}).onBorder);
}

TEST(SurfaceTree, RefusesMeshesThatAreNone) {
  Mesh mesh = cube();
  mesh.triangles[3][1] = 99;
  EXPECT_THROW(SurfaceTree{mesh}, Error);
  mesh = cube();
  mesh.points[2].x = NAN;
  EXPECT_THROW(SurfaceTree{mesh}, Error);
  EXPECT_THROW(SurfaceTree{Mesh{}}, Error);
  mesh = cube();
  for (Vec3& p : mesh.points) p = {1, 1, 1};
  EXPECT_THROW(SurfaceTree{mesh}, Error);
}

TEST(SurfaceTree, GivesTheSameBitsForManyPointsAsOneByOneAndForAnyNumberOfThreads) {
  const Mesh mesh = sheet(70);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(-5, 75), off(-8, 8);
  std::vector<Vec3> points(5000);
  for (Vec3& p : points) p = {along(random), off(random), along(random)};
  const int before = threads();
  std::vector<std::vector<SurfaceHit>> all;
  for (int count : {1, 2, 3}) {
    setThreads(count);
    all.push_back(SurfaceTree(mesh).closest(points, [](double) {}));
  }
  setThreads(before);
  const SurfaceTree tree(mesh);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfaceHit alone = tree.closest(points[i]);
    for (const auto& hits : all) {
      ASSERT_EQ(hits[i].triangle, alone.triangle) << i;
      ASSERT_EQ(hits[i].distance, alone.distance) << i;
    }
    ASSERT_NEAR(std::abs(alone.distance), bruteForce(mesh, points[i]), 1e-12);
  }
}

TEST(SurfaceTree, TakesAnyTriangleToBeginWith) {
  const Mesh mesh = sheet(12);
  const SurfaceTree tree(mesh);
  for (const Vec3 p : {Vec3{3.3, 1, 4.4}, {-20, 7, 3}, {5, 0, 5}}) {
    const SurfaceHit alone = tree.closest(p);
    for (int near = 0; near < int(mesh.triangles.size()); near += 7) EXPECT_EQ(tree.closest(p, near).triangle, alone.triangle);
  }
  // A corner of the mesh itself, where the distance to begin with is exactly zero.
  for (int near = 0; near < 40; ++near) EXPECT_EQ(tree.closest(mesh.points[40], near).distance, 0);
}

TEST(SurfaceTree, FollowsAPointThatMovesAroundAConvexBody) {
  // Seen from outside, the nearest place nearby is the nearest of all.
  const SurfaceTree tree(cube());
  std::mt19937 random(8);
  std::uniform_real_distribution<double> step(-0.4, 0.4);
  Vec3 p{1.5, 0, 0};
  int near = tree.closest(p).triangle;
  std::vector<bool> visited(12);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 next = p + Vec3{step(random), step(random), step(random)};
    const double size = std::max({std::abs(next.x), std::abs(next.y), std::abs(next.z)});
    if (size < 1.01 || size > 2) continue;
    p = next;
    const SurfaceHit hit = tree.closestNearby(p, near);
    ASSERT_NEAR(hit.distance, tree.closest(p).distance, 1e-12) << i;
    near = hit.triangle;
    visited[near] = true;
  }
  EXPECT_EQ(std::count(visited.begin(), visited.end(), true), 12);
}

TEST(SurfaceTree, FollowsAPointInAFoldToWithinTwiceItsWay) {
  const SurfaceTree tree(sheet(40));
  std::mt19937 random(8);
  std::uniform_real_distribution<double> along(2, 37), off(-0.8, 0.8), small(-0.05, 0.05);
  int exact = 0;
  constexpr int kCount = 2000;
  for (int i = 0; i < kCount; ++i) {
    const double x = along(random), z = along(random);
    const Vec3 p{x, 1.5 * std::sin(0.6 * x) * std::cos(0.4 * z) + off(random), z}, way{small(random), small(random), small(random)};
    const SurfaceHit followed = tree.closestNearby(p + way, tree.closest(p).triangle), truth = tree.closest(p + way);
    EXPECT_GE(std::abs(followed.distance), std::abs(truth.distance) - 1e-12);
    EXPECT_LE(std::abs(followed.distance), std::abs(truth.distance) + 2 * norm(way));
    exact += std::abs(followed.distance - truth.distance) < 1e-12;
  }
  EXPECT_GT(exact, 0.9 * kCount);
}

TEST(SurfaceTree, GivesPointsInTurnTheSameAsOneByOneHoweverTheyLie) {
  const SurfaceTree tree(sheet(70));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(-500, 500), small(-1, 1);
  // Groups near and far from the surface, close together and scattered.
  std::vector<Vec3> points;
  for (int group = 0; group < 40; ++group) {
    const Vec3 middle{35 + along(random) / (1 + group), along(random) / (1 + 2 * group), 35 + along(random) / (1 + group)};
    const double wide = std::pow(10.0, group % 5 - 2);
    for (int i = 0; i < 16; ++i) points.push_back(middle + Vec3{small(random), small(random), small(random)} * wide);
  }
  std::vector<SurfaceHit> hits(points.size());
  for (std::size_t i = 0; i < hits.size(); i += 3) hits[i].triangle = int(random() % 9000);   // anything to begin with
  tree.closestInTurn(points, hits);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfaceHit alone = tree.closest(points[i]);
    ASSERT_EQ(hits[i].triangle, alone.triangle) << i;
    ASSERT_EQ(hits[i].distance, alone.distance) << i;
  }
}

TEST(SurfaceTree, IsExactFarFromTheOriginAndFarFromTheMesh) {
  Mesh far = cube();
  for (Vec3& p : far.points) p += {1e6, -2e6, 3e6};
  const SurfaceTree tree(far);
  EXPECT_NEAR(tree.closest({1e6 + 3, -2e6, 3e6}).distance, 2, 1e-9);
  EXPECT_NEAR(tree.closest({1e6 + 0.5, -2e6, 3e6}).distance, -0.5, 1e-9);
  EXPECT_NEAR(SurfaceTree(cube()).closest({1e9, 0, 0}).distance, 1e9 - 1, 1e-6);
}

TEST(SurfaceTree, SeesThinTrianglesAndPassesOverThoseWithoutArea) {
  // A fan of needles 100 mm long and 1e-7 mm wide, beside triangles without area.
  Mesh needles;
  for (int i = 0; i < 40; ++i) {
    needles.points.insert(needles.points.end(), {{0, 0, double(i)}, {100, 0, double(i)}, {100, 0, i + 1e-7}});
    needles.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    needles.triangles.push_back({3 * i, 3 * i, 3 * i + 1});
  }
  const SurfaceTree tree(needles);
  for (int i = 0; i < 40; ++i) {
    const SurfaceHit hit = tree.closest({50, 3, i + 0.2});
    EXPECT_NEAR(std::abs(hit.distance), std::hypot(3, 0.2), 1e-6);
    EXPECT_EQ(hit.triangle, 2 * i);
  }
}

TEST(SurfaceTree, FindsItsWayOnNonManifoldMeshes) {
  // Three sheets that share an edge, one triangle given twice.
  Mesh fins;
  fins.points = {{0, 0, 0}, {0, 0, 10}, {10, 0, 5}, {-10, 0, 5}, {0, 10, 5}};
  fins.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 1, 4}, {0, 1, 4}};
  const SurfaceTree tree(fins);
  EXPECT_NEAR(std::abs(tree.closest({5, -2, 5}).distance), 2, 1e-12);
  EXPECT_FALSE(tree.closest({0, -2, 5}).onBorder);
  EXPECT_EQ(tree.closest({4, 4, 5}).triangle, 0);
  EXPECT_EQ(tree.closest({1, 4, 5}).triangle, 2);
}

TEST(SurfaceTree, RefusesCoordinatesBeyondAnyBody) {
  Mesh mesh = cube();
  mesh.points[2].x = 1e200;
  EXPECT_THROW(SurfaceTree{mesh}, Error);
}
