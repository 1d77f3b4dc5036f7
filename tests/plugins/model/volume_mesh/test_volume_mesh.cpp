#include "tests/plugins/model/common/barrel.h"

#include "plugins/model/volume_mesh/cells.h"
#include "plugins/model/volume_mesh/tissues.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace pectora;

namespace {

// A CT of the barrel: fat between 150 and 140 mm from the axis, muscle to 125 mm, a ring of bone at 128 to 138 mm and z below 60.
Volume barrelCt() {
  Volume ct;
  ct.grid.size = {160, 85, 105};
  ct.grid.spacing = {2, 2, 2};
  ct.grid.origin = {-159, -165, -3};
  ct.hu.resize(ct.grid.voxels());
  for (int k = 0; k < 105; ++k)
    for (int j = 0; j < 85; ++j)
      for (int i = 0; i < 160; ++i) {
        const Vec3 p = ct.grid.toPatient({double(i), double(j), double(k)});
        const double radius = std::hypot(p.x, p.y);
        ct.hu[ct.grid.index(i, j, k)] = radius > 150 || radius < 125 ? -900 : radius > 140 ? -100 : radius > 128 && radius < 138 && p.z < 60 ? 500 : 55;
      }
  return ct;
}

}  // namespace

TEST(VolumeMesh, HasNearlyCubicCellsAndThreeAtTheLeast) {
  EXPECT_EQ(cubicCells(built(barrel(), 5)), 5);
  EXPECT_EQ(cubicCells(built(barrel(), 8)), 3);
  EXPECT_EQ(cubicCells(built(barrel(), 20)), 3);
}

TEST(VolumeMesh, DividesTheWayFromSkinToPleuraEqually) {
  Scene scene = built(barrel(), 8);
  fillWall(4, scene);
  ASSERT_EQ(scene.layers(), 5);
  for (int l = 0; l < 5; ++l)
    for (int i = 0; i < scene.points(); ++i) {
      EXPECT_NEAR(distance(scene.layer(l)[i], scene.outer[i]), l / 4.0 * distance(scene.outer[i], scene.inner[i]), 1e-12);
      EXPECT_NEAR(distance(scene.layer(l)[i], scene.inner[i]), (4 - l) / 4.0 * distance(scene.outer[i], scene.inner[i]), 1e-12);
    }
}

TEST(VolumeMesh, WeighsWhatTheBarrelWeighs) {
  Scene scene = built(barrel(), 5);
  fillWall(5, scene);
  scene.tissues = {{"fat", 3, 0.49, 930}, {"muscle", 20, 0.49, 1060}, {"bone", 1000, 0.3, 1200}};
  scene.cellTissue.assign(scene.cells(), kMuscle);
  weighCells(scene);
  double total = 0;
  for (int l = 0; l < scene.layers(); ++l)
    for (const double m : scene.layerMass(l)) {
      EXPECT_GT(m, 0);
      total += m;
    }
  // Half of a tube; its outline of chords of 5 mm has 1 - (5 / 150)^2 / 6 of the area. Rays of the front leave the pleura's ends out.
  const double height = scene.outer.back().z - scene.outer.front().z;
  const double tube = std::numbers::pi / 2 * (kSkin * kSkin - kPleura * kPleura) * height * 1060e-9;
  EXPECT_NEAR(total, tube, 0.01 * tube);
}

TEST(VolumeMesh, FindsFatMuscleAndBoneInTheCt) {
  Scene scene = built(barrel(), 5);
  fillWall(5, scene);   // cells of 5 mm: two of fat, three of what is deeper
  sampleTissues(barrelCt(), scene);
  const int c = scene.columns / 2;
  int bone = 0, muscle = 0;
  for (int r = 0; r + 1 < scene.rows; ++r) {
    const double low = scene.outer[scene.index(r, c)].z, high = scene.outer[scene.index(r + 1, c)].z;
    const auto tissue = [&](int l) { return scene.cellTissue[scene.cell(l, r, c)]; };
    EXPECT_EQ(tissue(0), kFat);
    EXPECT_EQ(tissue(1), kFat);
    if (high >= 60 && low <= 60) continue;
    ++(high < 60 ? bone : muscle);
    EXPECT_EQ(tissue(3), high < 60 ? kBone : kMuscle) << low;
  }
  EXPECT_GT(bone, 3);
  EXPECT_GT(muscle, 3);
}

TEST(VolumeMesh, AssumesTheFatOfASlimChestWithoutACt) {
  Scene scene = built(barrel(), 5);
  fillWall(10, scene);   // cells of 2.5 mm
  assumeTissues(scene);
  const auto fatCells = [&](double x) {
    int column = 0;
    const int r = scene.rows - 4;   // above the end of the sternum
    for (int c = 1; c + 1 < scene.columns; ++c)
      if (std::abs(scene.outer[scene.index(r, c)].x - x) < std::abs(scene.outer[scene.index(r, column)].x - x)) column = c;
    int count = 0;
    for (int l = 0; l < 10; ++l) count += scene.cellTissue[scene.cell(l, r, column)] == kFat;
    return count;
  };
  EXPECT_EQ(fatCells(0), 2);               // 4 mm: the middles of cells lie 1.25, 3.75, 6.25 mm deep
  EXPECT_EQ(fatCells(-100), fatCells(95)); // about 8 mm
  EXPECT_GT(fatCells(100), fatCells(0));
}
