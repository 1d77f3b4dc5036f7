// Frames, components, smoothing, paths.
#include "plugins/segmenter/thorax/column_path.h"
#include "plugins/segmenter/thorax/components.h"
#include "plugins/segmenter/thorax/frame.h"
#include "plugins/segmenter/thorax/field.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pectora;
using namespace pectora::thorax;

namespace {

TEST(Upright, LeavesAnUprightCtAlone) {
  auto ct = std::make_shared<Volume>();
  ct->grid.size = {2, 2, 2};
  ct->hu.assign(8, 0);
  EXPECT_EQ(upright(ct), ct);
}

TEST(Upright, KeepsEveryVoxelAtItsPlaceInThePatient) {
  // Rows run to the head, columns to the right, slices to the front: right-handed.
  auto ct = std::make_shared<Volume>();
  ct->grid.size = {3, 4, 5};
  ct->grid.spacing = {2, 0.5, 3};
  ct->grid.origin = {10, 20, 30};
  ct->grid.axes = {{{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}}};
  for (std::size_t n = 0; n < ct->grid.voxels(); ++n) ct->hu.push_back(std::int16_t(n));
  const auto turned = upright(ct);
  EXPECT_EQ(turned->grid.size, (std::array<int, 3>{4, 5, 3}));
  for (int a = 0; a < 3; ++a) EXPECT_DOUBLE_EQ(turned->grid.axes[a][a], 1);
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 3; ++i) {
        const Vec3 v = turned->grid.toVoxel(ct->grid.toPatient({double(i), double(j), double(k)}));
        EXPECT_EQ(turned->at(int(std::lround(v.x)), int(std::lround(v.y)), int(std::lround(v.z))), ct->at(i, j, k));
      }
}

TEST(Frame, LocalAndPatientCoordinatesAreInverse) {
  Grid grid;
  grid.spacing = {0.7, 0.8, 2.5};
  grid.origin = {-100, 50, 7};
  const double c = std::cos(0.2), s = std::sin(0.2);
  grid.axes = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
  const Vec3 p{12, 34, 56};
  EXPECT_NEAR(distance(toLocal(grid, toPatient(grid, p)), p), 0, 1e-12);
}

TEST(Components, AreFaceConnectedAndNumberedByTheirFirstVoxel) {
  // Two voxels that touch only at an edge, and a U whose arms meet late.
  const std::vector<std::uint8_t> mask = {1, 0, 1, 0, 1,
                                          0, 1, 1, 1, 1,
                                          0, 0, 0, 0, 0};
  const Components c = components(mask, {5, 3, 1});
  EXPECT_EQ(c.voxels, (std::vector<std::size_t>{1, 6}));
  EXPECT_EQ(c.label[0], 1);
  EXPECT_EQ(c.label[2], 2);
  EXPECT_EQ(c.label[4], 2);
  EXPECT_EQ(c.label[6], 2);
  EXPECT_EQ(c.largest(), 2);
}

TEST(Components, OfNothingHaveNoLargest) { EXPECT_EQ(components({0, 0}, {2, 1, 1}).largest(), 0); }

TEST(Smoothing, KeepsAConstantAndSpreadsAPointByItsSigma) {
  Plane flat(9, 7, 42);
  smooth(flat, 1.5, 1.5);
  for (float v : flat.value) EXPECT_NEAR(v, 42, 1e-4);
  Plane point(41, 41);
  point.at(20, 20) = 1;
  smooth(point, 2, 3);
  double sum = 0, xx = 0, yy = 0;
  for (int j = 0; j < 41; ++j)
    for (int i = 0; i < 41; ++i)
      sum += point.at(i, j), xx += point.at(i, j) * (i - 20) * (i - 20), yy += point.at(i, j) * (j - 20) * (j - 20);
  EXPECT_NEAR(sum, 1, 1e-5);
  EXPECT_NEAR(std::sqrt(xx), 2, 0.05);  // the kernel is cut at 3 sigma
  EXPECT_NEAR(std::sqrt(yy), 3, 0.05);
}

TEST(Field, ReproducesALinearRampBetweenVoxels) {
  Volume ct;
  ct.grid.size = {20, 18, 16};
  ct.grid.spacing = {0.8, 0.9, 1.2};
  for (int k = 0; k < 16; ++k)
    for (int j = 0; j < 18; ++j)
      for (int i = 0; i < 20; ++i) ct.hu.push_back(std::int16_t(10 * i + 20 * j - 30 * k));
  const Field field(ct, Box{{2, 1, 0}, {20, 17, 16}}, 0.5);
  const Vec3 voxel{9.3, 8.6, 7.2};
  EXPECT_NEAR(field.at({voxel.x * 0.8, voxel.y * 0.9, voxel.z * 1.2}), 10 * voxel.x + 20 * voxel.y - 30 * voxel.z, 0.6);
  EXPECT_TRUE(field.contains({10, 10, 10}));
  EXPECT_FALSE(field.contains({0.8, 10, 10}));
}

TEST(Sums, GiveTheMeanOfARectangleCutToThePlane) {
  Plane plane(4, 3);
  for (int n = 0; n < 12; ++n) plane.value[n] = float(n);
  const Sums sums(plane);
  EXPECT_DOUBLE_EQ(sums.mean(1, 3, 0, 2), (1 + 2 + 5 + 6) / 4.0);
  EXPECT_DOUBLE_EQ(sums.mean(-5, 1, 2, 9), 8);
  EXPECT_DOUBLE_EQ(sums.mean(7, 9, 0, 1), 0);
}

TEST(BestColumn, FollowsASlopeAndIsNotLedAstrayByASinglePeak) {
  const int nx = 12, slices = 8;
  std::vector<float> score(std::size_t(nx) * slices, 0.0f);
  for (int s = 0; s < slices; ++s) score[std::size_t(s) * nx + 2 + s] = 1;
  score[4 * nx + 11] = 3;  // too far to go there and back
  const ColumnPath path = bestColumn(score, nx, 1, slices, 0, 1, 0.01f);
  for (int s = 0; s < slices; ++s) EXPECT_EQ(path.cell[s], 2 + s);
}

}  // namespace
