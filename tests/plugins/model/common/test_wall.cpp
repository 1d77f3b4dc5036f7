#include "tests/plugins/model/common/barrel.h"

#include "plugins/model/common/anchors.h"

#include "kernel/stage/error.h"
#include "kernel/value/motion.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pectora;

TEST(Layers, LieOnSkinAndPleuraAtTheWantedSpacing) {
  const Scene scene = built(barrel(), 8);
  EXPECT_NEAR(scene.rowSpacing, 8, 0.5);
  EXPECT_NEAR(scene.columnSpacing, 8, 0.5);
  // Rays cross the wall of 25 mm squarely in the middle, and a little obliquely beside it.
  EXPECT_GT(scene.thickness, kSkin - kPleura);
  EXPECT_LT(scene.thickness, 1.1 * (kSkin - kPleura));
  const int middle = scene.index(scene.rows / 2, scene.columns / 2);
  EXPECT_NEAR(distance(scene.outer[middle], scene.inner[middle]), kSkin - kPleura, 0.1);
  for (int i = 0; i < scene.points(); ++i) {
    EXPECT_NEAR(std::hypot(scene.outer[i].x, scene.outer[i].y), kSkin, 0.05);
    EXPECT_NEAR(std::hypot(scene.inner[i].x, scene.inner[i].y), kPleura, 0.05);
  }
  int first = 0;
  EXPECT_EQ(countInvertedPrisms(scene.rows, scene.columns, scene.outer, scene.inner, first), 0);
  EXPECT_LT(scene.outer.front().x, 0) << "column 0 is the patient's right";
  EXPECT_LT(scene.outer.front().z, scene.outer.back().z) << "row 0 is the lowest";
}

TEST(Layers, KeepToTheLongestRunOfWholeSkin) {
  auto cage = std::make_shared<RibCage>(*barrel());
  auto anatomy = std::make_shared<Anatomy>(*cage->anatomy);
  for (std::size_t i = 60; i < 70; ++i) anatomy->skin[i].clipped = true;  // 120 to 138 mm
  cage->anatomy = anatomy;
  const Scene scene = built(cage, 8);
  EXPECT_LE(scene.outer.back().z, 118.01);
}

TEST(Layers, AreRefusedWhereTooLittleIsInView) {
  auto cage = std::make_shared<RibCage>(*barrel());
  auto anatomy = std::make_shared<Anatomy>(*cage->anatomy);
  for (LayerSlice& s : anatomy->skin) s.clipped = true;
  cage->anatomy = anatomy;
  EXPECT_THROW(built(cage, 8), Error);
  anatomy = std::make_shared<Anatomy>();
  cage->anatomy = anatomy;
  EXPECT_THROW(built(cage, 8), Error);
}

TEST(Anchors, AreTheNearestPointsOfThreeDifferentBodies) {
  const Scene scene = built(barrel(), 10);
  const std::vector<Anchor> anchors = findAnchors(scene, 1000);
  ASSERT_EQ(anchors.size(), 3u * scene.points() + 2 * (scene.rows + scene.columns) - 4);
  for (int i = 0; i < scene.points(); ++i) {
    const Anchor* three = &anchors[3 * i];
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(three[k].point, i);
      for (int l = 0; l < k; ++l) EXPECT_TRUE(three[k].body != three[l].body || three[k].index != three[l].index);
      if (three[k].body == BodyKind::rib) {
        // No sample of the same rib is nearer than the anchor.
        double best = INFINITY;
        for (const Vec3& p : scene.cage->ribs[three[k].index].curve.sample(2000)) best = std::min(best, distance(p, scene.inner[i]));
        if (best >= 5) {
          // Samples 0.3 mm apart see a distance of 5 mm by 0.15^2 / 10 too large at most.
          EXPECT_NEAR(distance(three[k].rest, scene.inner[i]), best, 0.003);
        } else {
          EXPECT_EQ(three[k].rest, scene.inner[i]) << "glued to what touches it";
        }
      }
    }
    EXPECT_LE(distance(three[0].rest, scene.inner[i]), distance(three[2].rest, scene.inner[i]) + 1e-9);
  }
}

TEST(Anchors, HoldInPlaceWhatLiesTooFarFromEveryBody) {
  const Scene scene = built(barrel(), 10);
  const std::vector<Anchor> anchors = findAnchors(scene, 20);
  std::vector<int> perPoint(scene.points());
  int still = 0;
  for (const Anchor& a : anchors) {
    if (a.isOnSkin) continue;
    ++perPoint[a.point];
    if (a.body != BodyKind::still) continue;
    ++still;
    EXPECT_EQ(a.rest, scene.inner[a.point]);
  }
  EXPECT_GT(still, 0);
  for (int count : perPoint) EXPECT_TRUE(count == 1 || count == 3);
}

TEST(Anchors, HoldTheSkinAtTheEdgeOfTheModel) {
  const Scene scene = built(barrel(), 10);
  int held = 0;
  for (const Anchor& a : findAnchors(scene, 40)) {
    if (!a.isOnSkin) continue;
    ++held;
    const int r = a.point / scene.columns, c = a.point % scene.columns;
    EXPECT_TRUE(r == 0 || r == scene.rows - 1 || c == 0 || c == scene.columns - 1);
    EXPECT_EQ(a.rest, scene.outer[a.point]);
    EXPECT_EQ(a.body, BodyKind::still);
  }
  EXPECT_EQ(held, 2 * (scene.rows + scene.columns) - 4);
}
