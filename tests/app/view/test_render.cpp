// Cameras, shapes and picking, and what the renderer makes of them on a framebuffer.
#include "app/view/app.h"
#include "app/view/render/color_map.h"
#include "app/view/render/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace pectora;
using namespace pectora::view;

namespace {

// Volume within a closed surface, by the divergence theorem; positive if its triangles face outwards.
double volumeOf(const Surface& s) {
  double sum = 0;
  for (const auto& t : s.triangles) sum += dot(s.points[t[0]], cross(s.points[t[1]], s.points[t[2]])) / 6;
  return sum;
}

}  // namespace

TEST(Camera, SeesThePatientsLeftOnTheRightAndHisHeadAbove) {
  Camera camera;
  const Vec3 left = camera.project({50, 0, 0}), head = camera.project({0, 0, 50});
  EXPECT_GT(left.x, 0.5);
  EXPECT_NEAR(left.y, 0.5, 1e-12);
  EXPECT_LT(head.y, 0.5);
}

TEST(Camera, RaysGoThroughWhatItShowsThere) {
  Camera camera;
  camera.target = {10, -20, 30};
  camera.yaw = 0.7, camera.pitch = -0.4, camera.aspect = 1.6;
  const Vec3 point{40, -60, 100};
  const Vec3 at = camera.project(point);
  const Ray ray = camera.ray(at.x, at.y);
  EXPECT_LT(norm(cross(point - ray.origin, ray.direction)), 1e-9);
}

TEST(Camera, MovesAPointAcrossThePictureAtItsDepth) {
  Camera camera;
  camera.target = {10, -20, 30};
  camera.yaw = 0.7, camera.pitch = -0.4, camera.aspect = 1.6;
  const Vec3 point{40, -60, 100}, moved = camera.onPlane(point, 0.3, 0.8), at = camera.project(moved);
  EXPECT_NEAR(at.x, 0.3, 1e-12);
  EXPECT_NEAR(at.y, 0.8, 1e-12);
  EXPECT_NEAR(at.z, camera.project(point).z, 1e-9);
}

TEST(Camera, MatrixAndProjectionAgree) {
  Camera camera;
  camera.yaw = -0.5, camera.pitch = 0.3, camera.aspect = 1.4;
  const Vec3 p{35, 12, -80}, at = camera.project(p);
  const Matrix4 m = camera.matrix();
  const auto row = [&](int r) { return m[r] * p.x + m[4 + r] * p.y + m[8 + r] * p.z + m[12 + r]; };
  EXPECT_NEAR(row(0) / row(3), 2 * at.x - 1, 1e-5);   // floats
  EXPECT_NEAR(row(1) / row(3), 1 - 2 * at.y, 1e-5);
}

TEST(Camera, FramesABallWhole) {
  for (double aspect : {0.4, 1.0, 2.0}) {
    Camera camera;
    camera.aspect = aspect;
    camera.frame({}, 100);
    EXPECT_GT(camera.project({-100, 0, 0}).x, 0) << aspect;
    EXPECT_GT(camera.project({0, 0, 100}).y, 0) << aspect;
  }
}

TEST(Surface, TubesBarsAndBallsAreClosedAndFaceOutwards) {
  const std::vector<Vec3> line{{0, 0, 0}, {50, 0, 0}, {100, 0, 0}};
  // A regular polygon of n corners has n / 2 sin(2 pi / n) r^2.
  EXPECT_NEAR(volumeOf(tube(line, 5, 12)), 100 * 6 * std::sin(std::numbers::pi / 6) * 25, 1e-6);
  const double sphere = 4.0 / 3 * std::numbers::pi * 1000;
  EXPECT_NEAR(volumeOf(ball({3, 4, 5}, 10)) / sphere, 0.94, 0.03);   // 10 x 16 facets within the sphere
  // The bar has no ends: four faces of its section's sides.
  double area = 0;
  const Surface bar = sweptBar(line, {0, 0, 1}, 12, 3);
  for (const auto& t : bar.triangles) area += norm(cross(bar.points[t[1]] - bar.points[t[0]], bar.points[t[2]] - bar.points[t[0]])) / 2;
  EXPECT_NEAR(area, 100 * 2 * (12 + 3), 1e-6);
}

TEST(Surface, LoftOverEqualSquaresIsAColumn) {
  std::vector<std::vector<Vec3>> squares;
  for (int z = 0; z <= 40; z += 10) squares.push_back({{-10, -10, double(z)}, {10, -10, double(z)}, {10, 10, double(z)}, {-10, 10, double(z)}});
  // 40 directions cut the corners a little.
  EXPECT_NEAR(std::abs(volumeOf(loft(squares))), 20 * 20 * 40, 0.02 * 20 * 20 * 40);
}

TEST(Renderer, CutsWhatLiesBeforeThePlaneAndOnlyWhereThatIsAskedFor) {
  const ImGuiHolder imgui;
  const auto target = makeOffscreen(200, 200, 1);
  const Renderer renderer;
  GpuSurface gpu;
  gpu.upload(ball({0, 0, 0}, 50));
  Frame frame;
  frame.resize(200, 200, false);
  Camera camera;
  camera.frame({}, 60);
  // Pixels that are red on the patient's right and left: the ball is, the background is not.
  const auto reds = [&](const ClipPlane& clip, bool isClipped) {
    renderer.draw(frame, camera, {{&gpu, {.color = {1, 0, 0}, .isClipped = isClipped}}}, clip, 1);
    const std::vector<unsigned char> rgba = readPixels(frame.framebuffer(), 200, 200);
    std::pair<int, int> count{0, 0};
    for (int i = 0; i < 200 * 200; ++i)
      if (rgba[4 * i] > rgba[4 * i + 2] + 20) ++(i % 200 < 100 ? count.first : count.second);
    return count;
  };
  const auto whole = reds({}, true);
  EXPECT_GT(whole.first, 5000);
  EXPECT_NEAR(whole.first, whole.second, 100);
  const ClipPlane middle{true, {1, 0, 0}, 0};
  EXPECT_NEAR(reds(middle, true).first, whole.first, 200) << "its inside is seen at the cut";
  EXPECT_EQ(reds(middle, true).second, 0);
  EXPECT_EQ(reds(middle, false), whole);
  EXPECT_EQ(openGlErrors(), 0);
}

TEST(Renderer, ClosesACloudInPicturesOfAnySizeAndFromAnyDistance) {
  // A square of points 2 mm apart, as a scanner's, not quite in rows.
  Surface cloud;
  for (int r = 0; r < 100; ++r)
    for (int c = 0; c < 100; ++c) cloud.points.push_back({2.0 * c - 100 + 0.6 * std::sin(7.0 * r), 0.5 * std::sin(3.0 * c), 2.0 * r - 100 + 0.6 * std::sin(5.0 * c)});
  EXPECT_NEAR(pointSpacing(cloud.points), 2, 0.5);   // by boxes of 2.8 mm
  const ImGuiHolder imgui;
  const auto target = makeOffscreen(200, 200, 1);
  const Renderer renderer;
  GpuSurface gpu;
  gpu.upload(cloud);
  for (const int side : {150, 600, 1500})
    for (const double radius : {60.0, 200.0}) {
      Frame frame;
      frame.resize(side, side, false);
      Camera camera;
      camera.frame({}, radius);
      renderer.draw(frame, camera, {{&gpu, {.color = {1, 0, 0}}}}, {}, 1);
      const std::vector<unsigned char> rgba = readPixels(frame.framebuffer(), side, side);
      int gaps = 0, inside = 0;
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          const Vec3 at = camera.onPlane({}, (x + 0.5) / side, (y + 0.5) / side);
          if (std::abs(at.x) > 95 || std::abs(at.z) > 95) continue;
          ++inside;
          gaps += rgba[4 * (std::size_t(y) * side + x)] < rgba[4 * (std::size_t(y) * side + x) + 2] + 20;
        }
      EXPECT_GT(inside, 1000);
      EXPECT_EQ(gaps, 0) << side << " pixels, " << radius << " mm";
    }
  EXPECT_EQ(openGlErrors(), 0);
}

TEST(Pick, FindsTheFirstSurfaceAndItsNearestPoint) {
  const Surface s = ball({0, 0, 0}, 10);
  const auto hit = pick(s, {{0.5, -100, 0.7}, {0, 1, 0}});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 90, 0.6);   // facets lie within the sphere
  EXPECT_LT(distance(s.points[hit->point], hit->position), 4);
  EXPECT_FALSE(pick(s, {{20, -100, 0}, {0, 1, 0}}));
}

TEST(Pick, TakesThePointOfACloudThatIsInFront) {
  Surface cloud;
  cloud.points = {{0, 50, 0}, {1, -50, 0}, {40, -90, 0}};
  const auto hit = pick(cloud, {{0, -200, 0}, {0, 1, 0}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->point, 1);
}

TEST(ColorMap, IsPaleInTheMiddleWhereItDivergesAndGrowsLighterWhereItDoesNot) {
  const auto lightness = [](Rgb c) { return 0.3 * c[0] + 0.59 * c[1] + 0.11 * c[2]; };
  for (int i = 0; i < 20; ++i) EXPECT_LT(lightness(colorAt(ColorMap::sequential, i / 20.0)), lightness(colorAt(ColorMap::sequential, (i + 1) / 20.0)));
  EXPECT_GT(lightness(colorAt(ColorMap::diverging, 0.5)), 0.9);
  EXPECT_GT(colorAt(ColorMap::diverging, 1)[0], colorAt(ColorMap::diverging, 1)[2]) << "positive is red";
}

TEST(ColorMap, RangeIsARoundFigureThatLeavesOutStrays) {
  std::vector<double> values(1000, 4.2);
  values[0] = 300, values[1] = NAN;
  EXPECT_EQ(roundLimit(values.data(), values.size()), 5);
  EXPECT_EQ(roundLimit(nullptr, 0), 1);
}
