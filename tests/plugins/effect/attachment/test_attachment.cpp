// What the pleura hangs on.
#include "plugins/effect/attachment/carried.h"

#include "tests/plugins/solver/wall.h"

using namespace pectora;

namespace {

// The wall with its last effect, the attachment, as told.
Wall heldBy(const char* hold, double lift) {
  Wall wall(lift);
  wall.scene->effects.back() = call("effect.attachment", {{"youngs_modulus", 60.0}, {"hold", std::string(hold)}});
  return wall;
}

}  // namespace

TEST(Carried, GoesTheMeanWayOfItsBonesByTheirStiffness) {
  Carried carried;
  carried.add(7, {1, 2, 3}, 0, {0, 0, 0}, 1);
  carried.add(5, {9, 9, 9}, 2, {4, 4, 4}, 2);
  carried.add(7, {1, 2, 3}, 1, {10, 0, 0}, 3);
  ASSERT_EQ(carried.points().size(), 2u);
  EXPECT_EQ(carried.points()[0].node, 7u);
  EXPECT_DOUBLE_EQ(carried.points()[0].stiffness, 4);
  // The first bone goes 8 mm forwards, the second stands still, the third goes up.
  const auto places = carried.places({{0, -8, 0}, {10, 0, 0}, {4, 4, 5}});
  EXPECT_EQ(places[0], (Vec3{1, 2 - 8 * 0.25, 3}));
  EXPECT_EQ(places[1], (Vec3{9, 9, 10}));
}

TEST(Attachment, PullsAsTheSumOfItsBlocks) {
  // Where the bones went and the wall has not followed, the force on a pleura point is sum k_j u_j: E A / L each.
  Registry registry({PECTORA_PLUGINS});
  const Wall wall = heldBy("carried", 10);
  const Compiled compiled = compile(*wall.scene, registry);
  const System& system = *compiled.system;
  NodeVectors x = system.rest, gradient(x.size());
  makeDrive(*wall.scene, compiled, *wall.plan).apply(1, system.freeNodes, x);
  double largest = 0;
  system.evaluate(x, gradient, largest);
  const int middle = wall.scene->index(8, 8);
  double expected = 0;
  for (const Anchor& anchor : wall.scene->anchors)
    if (anchor.point == middle) expected += 60e-3 * 64 / distance(anchor.rest, wall.scene->inner[middle]) * 10;
  EXPECT_NEAR(gradient.y[system.node(1, std::size_t(middle))], expected, 1e-9 * expected);
}

TEST(Attachment, OfBonesThatGoTogetherTakesTheWallAlongWithoutStrain) {
  for (const char* hold : {"carried", "struts"}) {
    Wall wall = heldBy(hold, 12);
    for (Anchor& anchor : wall.scene->anchors) anchor.body = BodyKind::sternum;
    const auto motion = Solve("solver.newton")(wall, {{"tolerance", 1e-10}});
    for (std::size_t i = 0; i < motion->outer.size(); ++i) EXPECT_LT(norm(motion->outer[i] - wall.scene->outer[i] - Vec3{0, -12, 0}), 1e-6) << hold;
    EXPECT_LT(motion->energy, 1e-9) << hold;
  }
}

TEST(Attachment, CarriedComesToTheSameEndThoughTheBonesPassThroughThePleura) {
  // The bones lie 3 to 6 mm behind the pleura and go 30 mm forwards. A strut can come to rest on either side of its bone; a block pulls
  // its point after the bone, from wherever it begins.
  const Wall wall = heldBy("carried", 30);
  Solve solve("solver.newton");
  const auto end = solve(wall, {{"tolerance", 1e-8}});
  auto pushed = std::make_shared<Motion>(*end);
  for (Vec3& p : pushed->inner) p.y += 12;
  EXPECT_LT(largestDifference(solve(wall, {{"tolerance", 1e-8}}, pushed)->inner, end->inner), 1e-4);
}

TEST(Attachment, FollowsBonesThatOtherEffectsMove) {
  // The breathing of test_respiration is that effect's; here the way of anchors that the plan knows nothing of must reach the pleura.
  Registry registry({PECTORA_PLUGINS});
  const Wall wall = heldBy("carried", 0);
  Compiled compiled = compile(*wall.scene, registry);
  Steering other;
  other.displacement = [](const Plan&, const Anchor&) { return Vec3{0, 0, 5}; };
  compiled.steering.push_back({other, 0});
  const Drive drive = makeDriveEnd(*wall.scene, compiled, *wall.plan);
  const std::size_t anchors = wall.scene->anchors.size();
  ASSERT_GT(drive.frames.back().size(), anchors);
  for (std::size_t i = anchors; i < drive.frames.back().size(); ++i)
    EXPECT_LT(norm(drive.frames.back()[i] - compiled.system->rest[compiled.system->freeNodes + i] - Vec3{0, 0, 5}), 1e-12);
}
