#include "kernel/value/motion.h"

#include <gtest/gtest.h>

using namespace pectora;

namespace {

// A flat wall: skin at y = -20, pleura at y = 0, columns to the patient's left, rows to the head.
void flatWall(int rows, int columns, std::vector<Vec3>& outer, std::vector<Vec3>& inner) {
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) outer.push_back({8.0 * c, -20, 8.0 * r}), inner.push_back({8.0 * c, 0, 8.0 * r});
}

}  // namespace

TEST(LayerMesh, TrianglesFaceOutOfTheBody) {
  std::vector<Vec3> outer, inner;
  flatWall(3, 4, outer, inner);
  const Mesh mesh = layerMesh(3, 4, outer);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  for (const auto& t : mesh.triangles)
    EXPECT_LT(cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]).y, 0);
}

TEST(DisplacedSkin, HasItsPointsElsewhereAndTellsHowFar) {
  auto scene = std::make_shared<Scene>();
  scene->rows = 2, scene->columns = 3;
  flatWall(2, 3, scene->outer, scene->inner);
  std::vector<Vec3> outer = scene->outer;
  outer[1] += {3, -4, 12};
  const Mesh mesh = displacedSkin(*scene, outer);
  EXPECT_EQ(mesh.points, outer);
  EXPECT_EQ(mesh.triangles, layerMesh(2, 3, {}).triangles);
  ASSERT_EQ(mesh.fields.size(), 1u);
  EXPECT_EQ(mesh.fields[0].name, "displacement");
  EXPECT_EQ(mesh.fields[0].unit, "mm");
  EXPECT_EQ(mesh.fields[0].values, (std::vector<double>{0, 13, 0, 0, 0, 0}));

  // It is what a motion leads to.
  Motion motion;
  motion.scene = scene, motion.outer = outer, motion.inner = scene->inner;
  for (const auto& [name, part] : motion.parts()) {
    if (name != "after") continue;
    const auto& after = dynamic_cast<const Mesh&>(*part);
    EXPECT_EQ(after.points, outer);
    EXPECT_EQ(after.fields.at(0).values, mesh.fields[0].values);
  }
}

TEST(SkinThatCopiesBone, MovesAsTheMeanOfTheAnchorsBehindItByTheirNearness) {
  auto scene = std::make_shared<Scene>();
  scene->rows = 2, scene->columns = 3;
  flatWall(2, 3, scene->outer, scene->inner);
  Motion motion;
  // Point 0: a moving bone 1 mm away and a still one 2 mm away; point 1: on the bone; point 2: none; point 3: held on the skin only.
  const auto anchor = [&](int point, Vec3 off, Vec3 move, bool isOnSkin) {
    scene->anchors.push_back({point, BodyKind::sternum, 0, 0, (isOnSkin ? scene->outer : scene->inner)[point] + off, isOnSkin});
    motion.anchors.push_back(scene->anchors.back().rest + move);
  };
  anchor(0, {0, 1, 0}, {0, -10, 0}, false);
  anchor(0, {0, 0, 2}, {0, 0, 0}, false);
  anchor(1, {0, 0, 0}, {1, -30, 2}, false);
  anchor(3, {0, 0, 0}, {0, -5, 0}, true);
  motion.scene = scene;
  const std::vector<Vec3> skin = skinThatCopiesBone(motion);
  EXPECT_NEAR(skin[0].y, -20 - 10 * (1.0 / (1.0 + 0.25)), 1e-12);
  EXPECT_LT(distance(skin[1], scene->outer[1] + Vec3{1, -30, 2}), 1e-12);
  EXPECT_EQ(skin[2], scene->outer[2]);
  EXPECT_EQ(skin[3], scene->outer[3]);
}

TEST(InvertedPrisms, AreNoneAtRest) {
  std::vector<Vec3> outer, inner;
  flatWall(5, 6, outer, inner);
  int first = 0;
  EXPECT_EQ(countInvertedPrisms(5, 6, outer, inner, first), 0);
  EXPECT_EQ(first, -1);
}

TEST(InvertedPrisms, AreFoundWhereSkinIsMirroredThroughThePleura) {
  // The mirror image has no spring energy at all: only the orientation tells.
  std::vector<Vec3> outer, inner;
  flatWall(5, 6, outer, inner);
  for (Vec3& p : outer) p.y = -p.y;
  int first = -1;
  EXPECT_EQ(countInvertedPrisms(5, 6, outer, inner, first), 20);
  EXPECT_EQ(first, 0);
}

TEST(InvertedPrisms, AreCountedAroundASinglePointPushedThrough) {
  std::vector<Vec3> outer, inner;
  flatWall(5, 6, outer, inner);
  outer[2 * 6 + 3].y = 5;
  int first = -1;
  EXPECT_EQ(countInvertedPrisms(5, 6, outer, inner, first), 4);
  EXPECT_EQ(first, 1 * 6 + 2);
}
