#include "plugins/splines/cartilage/guess.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace pectora;

namespace {

constexpr double kHandle = 0.38;

// Three cartilages of the left side that come down from their ribs and turn up to the sternum, 16 mm one below another.
std::vector<Ends> threeEnds() {
  std::vector<Ends> ends;
  for (int n = 0; n < 3; ++n)
    ends.push_back({{90, 30, 100.0 - 16 * n}, normalized(Vec3{-0.6, 0, -0.8}), {18, 30, 105.0 - 16 * n}, arrivalAtSternum(Side::left, 5)});
  return ends;
}

// Cartilage of 100 HU within 6 mm of the courses, in muscle of 55 HU; voxels of 1.3 mm.
Volume drawn(const std::vector<Ends>& ends, const SideShape& shape, const Anatomy& anatomy) {
  Volume ct;
  ct.grid.size = {90, 70, 110};
  ct.grid.spacing = {1.3, 1.3, 1.3};
  ct.hu.assign(ct.grid.voxels(), 55);
  for (const Ends& one : ends)
    for (const Vec3& p : resamplePolyline(guessCourse(one, shape, kHandle, anatomy), 200)) {
      const Vec3 v = ct.grid.toVoxel(p);
      for (int k = int(v.z) - 5; k <= int(v.z) + 5; ++k)
        for (int j = int(v.y) - 5; j <= int(v.y) + 5; ++j)
          for (int i = int(v.x) - 5; i <= int(v.x) + 5; ++i)
            if (distance(ct.grid.toPatient({double(i), double(j), double(k)}), p) < 6) ct.hu[ct.grid.index(i, j, k)] = 100;
    }
  return ct;
}

SideShape found(const std::vector<Ends>& ends, const Volume& ct, const Anatomy& anatomy) {
  const std::vector<Vec3> corners{ct.grid.toPatient({0, 0, 0}), ct.grid.toPatient({89, 69, 109})};
  return bestShape(ends, kHandle, anatomy, WallVoxels(ct, anatomy, corners, 0, 0), 100, 1);
}

// A front of a layer: flat at y, with a trench of `depth` mm, 12 mm wide, around x = 45.
std::vector<LayerSlice> front(double y, double depth) {
  std::vector<LayerSlice> layer;
  for (double z = 0; z <= 142; z += 2) {
    LayerSlice slice{z, {}, false};
    for (double x = 0; x <= 116; x += 1) slice.points.push_back({x, y + depth * std::exp(-(x - 45) * (x - 45) / 288), z});
    layer.push_back(slice);
  }
  return layer;
}

// From the points of one line to the nearest of the other.
double rmsBetween(const std::vector<Vec3>& points, const std::vector<Vec3>& line) {
  const std::vector<Vec3> fine = resamplePolyline(line, 1000);
  double sum = 0;
  for (const Vec3& p : points) {
    double nearest = 1e9;
    for (const Vec3& q : fine) nearest = std::min(nearest, distance(p, q));
    sum += nearest * nearest;
  }
  return std::sqrt(sum / double(points.size()));
}

}  // namespace

TEST(GuessCourse, TurnsBothSidesUpAlikeWhenItTurns) {
  Ends left{{90, 30, 100}, {-1, 0, 0}, {18, 30, 105}, arrivalAtSternum(Side::left, 3)}, right = left;
  for (Vec3* v : {&right.start, &right.leaving, &right.end}) v->x = -v->x;
  right.arriving = arrivalAtSternum(Side::right, 3);
  for (const double turn : {-30.0, 0.0, 30.0}) {
    std::vector<Vec3> a = guessCourse(left, {1, 1, turn}, kHandle, {}), b = guessCourse(right, {1, 1, turn}, kHandle, {});
    for (Vec3& p : b) p.x = -p.x;
    EXPECT_LT(rmsBetween(a, b), 0.1) << turn;   // the fine line is 0.1 mm apart
  }
}

TEST(BestShape, FindsTheShapeThatTheCtShows) {
  const std::vector<Ends> ends = threeEnds();
  for (const SideShape shape : {SideShape{}, SideShape{2, 0.5, -30}, SideShape{0.5, 1.5, 15}}) {
    const SideShape best = found(ends, drawn(ends, shape, {}), {});
    // Shapes beside it differ by less than a quarter of a cartilage's height; a wrong one by 5 mm and more.
    for (const Ends& one : ends)
      EXPECT_LT(rmsBetween(guessCourse(one, best, kHandle, {}), guessCourse(one, shape, kHandle, {})), 3.5) << shape.firstHandle;
  }
}

TEST(BestShape, FollowsTheSkinIntoATrenchThatThePleuraCutsAcross) {
  const std::vector<Ends> ends = threeEnds();
  Anatomy anatomy;
  anatomy.pleura = front(40, 0), anatomy.skin = front(15, 16);
  EXPECT_TRUE(found(ends, drawn(ends, {1, 1, 0, true}, anatomy), anatomy).followsSkin);
  EXPECT_FALSE(found(ends, drawn(ends, {1, 1, 0, false}, anatomy), anatomy).followsSkin);
}
