#include "tests/kernel/host/helpers.h"

#include "kernel/host/compile.h"

using namespace pectora;

namespace {

// A flat wall of 6 x 7 points, each pleura point hung on an anchor behind it.
Scene flatScene() {
  Scene scene;
  scene.cage = std::make_shared<RibCage>();
  scene.rows = 6;
  scene.columns = 7;
  scene.rowSpacing = scene.columnSpacing = 8;
  scene.thickness = 20;
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 7; ++c) {
      scene.outer.push_back({8.0 * c, -20, 8.0 * r});
      scene.inner.push_back({8.0 * c, 0, 8.0 * r});
      scene.anchors.push_back({scene.index(r, c), BodyKind::rib, 0, 0, {8.0 * c, 6, 8.0 * r}});
    }
  scene.outerMass.assign(42, 1e-3);
  scene.innerMass = scene.outerMass;
  return scene;
}

}  // namespace

TEST(Compile, FusesAllStencilsIntoOneTerm) {
  Registry registry({PECTORA_PLUGINS});
  Scene scene = flatScene();
  scene.effects = {call("effect.stretch"), call("effect.shear"), call("effect.cross"), call("effect.direct"), call("effect.attachment")};
  const Compiled compiled = compile(scene, registry);
  ASSERT_EQ(compiled.system->terms.size(), 2u);
  EXPECT_EQ(compiled.system->terms[0]->name(), "stretch, shear, cross, direct");
  EXPECT_EQ(compiled.effects[0].springs, 6u * 6 + 5 * 7);
  EXPECT_EQ(compiled.effects[4].springs, 42u);
}

TEST(Compile, DoesNotMapEffectsThatTheSceneDoesNotCall) {
  Registry registry({PECTORA_PLUGINS});
  Scene scene = flatScene();
  scene.effects = {call("effect.direct"), call("effect.attachment")};
  compile(scene, registry);
  EXPECT_TRUE(isMapped("effect.direct.so"));
  EXPECT_FALSE(isMapped("effect.bend.so"));
}

TEST(Compile, DropsAnEffectThatIsEmptyHereAndSaysWhy) {
  Registry registry({PECTORA_PLUGINS});
  Scene scene = flatScene();
  scene.effects = {call("effect.direct"), call("effect.tissue"), call("effect.attachment")};
  const Compiled compiled = compile(scene, registry);
  EXPECT_FALSE(compiled.effects[1].isActive);
  EXPECT_FALSE(compiled.effects[1].reason.empty());
  EXPECT_EQ(compiled.system->terms.size(), 2u);
}

TEST(Compile, NamesThePointsThatHangTogetherButOnNothing) {
  Registry registry({PECTORA_PLUGINS});
  Scene scene = flatScene();
  scene.effects = {call("effect.stretch"), call("effect.attachment")};
  const Error error = errorOf([&] { compile(scene, registry); });
  EXPECT_TRUE(contains(error.what(), "42 of 84 points")) << error.what();
  EXPECT_TRUE(contains(error.what(), "skin point at row 0, column 0")) << error.what();
}

TEST(Compile, NamesThePointsThatNothingHolds) {
  Registry registry({PECTORA_PLUGINS});
  Scene scene = flatScene();
  scene.effects = {call("effect.attachment")};
  const std::string text = errorOf([&] { compile(scene, registry); }).what();
  EXPECT_TRUE(contains(text, "42 of 84")) << text;
  EXPECT_TRUE(contains(text, "skin point at row 0, column 0")) << text;
}

TEST(Compile, NumbersTheLayersFromSkinToPleura) {
  Registry registry({PECTORA_PLUGINS});
  Scene scene = flatScene();
  scene.between = {scene.outer, scene.outer};
  for (Vec3& p : scene.between[0]) p.y = -15;
  for (Vec3& p : scene.between[1]) p.y = -5;
  scene.betweenMass.assign(2, std::vector<double>(42, 2e-3));
  scene.effects = {call("effect.direct"), call("effect.attachment")};
  // Springs join skin and pleura, so nothing holds the layers between.
  const std::string text = errorOf([&] { compile(scene, registry); }).what();
  EXPECT_TRUE(contains(text, "84 of 168")) << text;
  EXPECT_TRUE(contains(text, "point of layer 1 at row 0, column 0")) << text;
  scene.betweenMass[1][8] = NAN;
  EXPECT_TRUE(contains(errorOf([&] { compile(scene, registry); }).what(), "point of layer 2 at row 1, column 1"));
  scene.betweenMass[1][8] = 2e-3;
  scene.anchors[5].rest.x = NAN;
  EXPECT_TRUE(contains(errorOf([&] { compile(scene, registry); }).what(), "anchor 5"));
}

TEST(Compile, RefusesZeroMassAndPositionsThatAreNotFinite) {
  Registry registry({PECTORA_PLUGINS});
  Scene scene = flatScene();
  scene.effects = {call("effect.direct"), call("effect.attachment")};
  scene.outerMass[9] = 0;
  EXPECT_TRUE(contains(errorOf([&] { compile(scene, registry); }).what(), "row 1, column 2"));
  scene = flatScene();
  scene.inner[3].y = NAN;
  EXPECT_THROW(compile(scene, registry), Error);
}

TEST(Compile, HandGivenStiffnessReplacesTheCalibration) {
  Registry registry({PECTORA_PLUGINS});
  Scene scene = flatScene();
  scene.effects = {call("effect.direct", {{"stiffness", 0.5}}), call("effect.attachment", {{"stiffness", 2.0}})};
  const std::vector<double> bound = compile(scene, registry).system->stiffnessBound();
  EXPECT_DOUBLE_EQ(bound[0], 2 * 0.5);
  EXPECT_DOUBLE_EQ(bound[42], 2 * 0.5 + 2.0);
}
