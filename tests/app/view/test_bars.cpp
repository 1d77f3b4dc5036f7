// The bar's panel: tilt and a second bar, by sliders and with the mouse in the scene.
#include "tests/app/view/desk.h"

#include "app/view/session/script_text.h"

using namespace pectora;
using namespace pectora::view;

namespace {

// Where a point of a bar stands in the scene, in parts of it.
ImVec2 inScene(Desktop& desk, Vec3 point) {
  const Vec3 at = desk.app.camera().project(point);
  return {float(at.x), float(at.y)};
}

const Plan& planOf(Desktop& desk) { return *desk.results().planValue(); }

}  // namespace

TEST(Bars, AreTiltedBySliderAndByTheirEnds) {
  Desktop desk("view_tilt_home");
  desk.openPhantom();
  desk.click("tab.bar");
  desk.click("view.front");
  desk.hand.drag("bar.tilt", {0.5f, 0.5f}, {0.7f, 0.5f});
  desk.rest();
  const double tilt = planOf(desk).bars[0].tiltDeg();
  EXPECT_GT(tilt, 5);
  const auto skin = *desk.results().skin;

  // The left end drawn down by about as much as it rises over the right one.
  const std::vector<Vec3> line = planOf(desk).bars[0].centerline;
  const auto left = std::find_if(line.begin(), line.end(), [](Vec3 p) { return p.x > 80; });
  ASSERT_NE(left, line.end());
  desk.hand.drag("scene", inScene(desk, *left), inScene(desk, {left->x, left->y, left->z - (left->x - planOf(desk).bars[0].point.x) * std::tan(tilt * 0.01745)}));
  desk.rest();
  EXPECT_NEAR(planOf(desk).bars[0].tiltDeg(), 0, 1.5);   // a pixel over 80 mm, and the turn is not small
  EXPECT_EQ(planOf(desk).lift(), 30);
  EXPECT_EQ(desk.results().error, "");
}

TEST(Bars, ASecondOneIsTakenInMovedAndTakenOut) {
  Desktop desk("view_second_home");
  desk.openPhantom();
  desk.click("tab.bar");
  const auto alone = *desk.results().skin;
  desk.click("bar.second");
  ASSERT_EQ(planOf(desk).bars.size(), 2u) << desk.results().error;
  const Bar second = planOf(desk).bars[1];
  EXPECT_NEAR(second.point.z, planOf(desk).bars[0].point.z + 40, 5);   // to a slice
  EXPECT_NE(alone, *desk.results().skin);

  // Taken at its middle and drawn down and to the back.
  desk.click("view.left");
  const Vec3 middle = second.centerline[second.centerline.size() / 2];
  desk.hand.drag("scene", inScene(desk, middle), inScene(desk, middle + Vec3{0, 8, -10}));
  desk.rest();
  ASSERT_EQ(planOf(desk).bars.size(), 2u) << desk.results().error;
  EXPECT_NEAR(planOf(desk).bars[1].lift, second.lift - 8, 1);
  EXPECT_LT(planOf(desk).bars[1].point.z, second.point.z);
  EXPECT_EQ(planOf(desk).lift(), 30) << "the first stays";
  EXPECT_NE(scriptOf(desk.context().choices).find("second_lift"), std::string::npos);

  // Too near to the first: told in one sentence, and the last good plan stays.
  assign(desk.context().choices.planner.settings, "second_level", 4.0);
  desk.context().changed(false);
  desk.rest();
  EXPECT_NE(desk.results().error.find("the two bars lie on each other"), std::string::npos) << desk.results().error;
  desk.click("undo");
  desk.click("bar.second");
  EXPECT_EQ(planOf(desk).bars.size(), 1u);
  EXPECT_EQ(alone, *desk.results().skin);
}
