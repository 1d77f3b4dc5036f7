// What the segmenter got wrong is corrected with the mouse, and stands in the script.
#include "tests/app/view/desk.h"

#include "app/view/session/corrections.h"
#include "app/view/session/script_text.h"

using namespace pectora;
using namespace pectora::view;

namespace {

Vec3 notchAt(const Anatomy& anatomy, Side side, int rib) {
  for (const Notch& notch : anatomy.sternum.notches)
    if (notch.side == side && notch.rib == rib) return notch.position;
  ADD_FAILURE() << "no notch of rib " << rib;
  return {};
}

int cartilagesOf(const Results& results, Side side, int rib) {
  const auto& all = results.cageValue()->cartilages;
  return int(std::count_if(all.begin(), all.end(), [&](const Cartilage& c) { return c.side == side && c.rib == rib; }));
}

}  // namespace

TEST(Corrections, OfOneJointReplaceEachOtherAndOthersAreKept) {
  Choices choices;
  const RibName rib{Side::left, 3};
  addCorrection(choices, jointMoved(Joint::notch, rib, {1, 2, 3.04}));
  addCorrection(choices, jointMoved(Joint::notch, rib, {1, 2, 4}));
  addCorrection(choices, jointMoved(Joint::junction, rib, {1, 2, 4}));
  addCorrection(choices, ribRenumbered(rib, 4));
  addCorrection(choices, ribDropped({Side::right, 0, {5, 6, 7}}));
  ASSERT_EQ(choices.corrections.size(), 4u);
  EXPECT_EQ(correctionText(choices.corrections[0]), "Left notch 3 moved");
  EXPECT_EQ(correctionText(choices.corrections[1]), "Left junction 3 moved");
  EXPECT_EQ(correctionText(choices.corrections[2]), "Left rib 3 is 4");
  EXPECT_EQ(correctionText(choices.corrections[3]), "Right rib ? left out");
}

TEST(Corrections, ByTheMouseChangeTheChestAndCanBeUndone) {
  Desktop desk("view_corrections_home");
  desk.openPhantom();
  desk.click("tab.anatomy");
  desk.click("correct");

  // A notch, drawn by 20 pixels down in the axial slice: backwards, and not along the body.
  desk.click("correct.rib");
  desk.click("correct.Left rib 4");
  desk.click("correct.notch");
  const Vec3 before = notchAt(*desk.results().anatomyValue(), Side::left, 4);
  const auto skin = *desk.results().skin;
  ASSERT_TRUE(desk.hand.sees("slice.Axial.notch"));
  const ImVec2 from = desk.hand.place("slice.Axial.notch"), corner = desk.hand.place("slice.Axial", 0, 0), end = desk.hand.place("slice.Axial", 1, 1);
  const ImVec2 a{(from.x - corner.x) / (end.x - corner.x), (from.y - corner.y) / (end.y - corner.y)}, b{a.x, a.y + 20 / (end.y - corner.y)};
  desk.hand.drag("slice.Axial", a, b);
  desk.rest();
  const Vec3 after = notchAt(*desk.results().anatomyValue(), Side::left, 4);
  EXPECT_NEAR(after.x, before.x, 1);   // a pixel
  EXPECT_NEAR(after.z, before.z, 0.1);
  EXPECT_GT(after.y, before.y + 3);
  EXPECT_TRUE(desk.results().motion.record) << desk.results().error;
  EXPECT_NE(scriptOf(desk.context().choices).find("anatomy = correct.joint(anatomy, {"), std::string::npos);
  EXPECT_NE(skin, *desk.results().skin);

  // A rib is none; it is chosen by a click on its middle line.
  ASSERT_EQ(cartilagesOf(desk.results(), Side::left, 4), 1);
  desk.click("correct.junction");
  const ImVec2 joint = desk.hand.place("slice.Axial.junction");
  desk.click("correct.rib");
  desk.click("correct.Right rib 2");
  desk.click("correct.rib");
  desk.click("correct.Left rib 4");   // the planes are at its end again
  desk.click("slice.Axial", (joint.x - corner.x) / (end.x - corner.x), (joint.y - corner.y) / (end.y - corner.y));
  desk.click("correct.drop");
  EXPECT_EQ(desk.results().anatomyValue()->rib(Side::left, 4), nullptr);
  EXPECT_EQ(cartilagesOf(desk.results(), Side::left, 4), 0);
  EXPECT_EQ(desk.results().error, "");

  // Its number is free now, and rib 3 takes it.
  desk.click("correct.rib");
  desk.click("correct.Left rib 3");
  desk.click("correct.number");
  desk.click("correct.number.4");
  EXPECT_EQ(desk.results().anatomyValue()->rib(Side::left, 3), nullptr);
  EXPECT_NE(desk.results().anatomyValue()->rib(Side::left, 4), nullptr);
  EXPECT_EQ(desk.context().choices.corrections.size(), 3u);

  // The script of it is opened as the same choices.
  const Choices made = desk.context().choices;
  std::ofstream(desk.home + "/session.lua") << scriptOf(made);
  desk.context().open(desk.home + "/session.lua");
  desk.rest();
  EXPECT_EQ(firstDifference(desk.context().choices, made), Step::nothing) << scriptOf(desk.context().choices);

  // Step by step back.
  desk.click("undo"), desk.click("undo");
  EXPECT_EQ(desk.context().choices.corrections.size(), 1u);
  desk.click("undo");
  EXPECT_TRUE(desk.context().choices.corrections.empty());
  EXPECT_EQ(distance(notchAt(*desk.results().anatomyValue(), Side::left, 4), before), 0);
  EXPECT_EQ(skin, *desk.results().skin);
  desk.click("redo");
  EXPECT_EQ(distance(notchAt(*desk.results().anatomyValue(), Side::left, 4), after), 0);
  desk.click("correct.forget.0");
  EXPECT_TRUE(desk.context().choices.corrections.empty());
  EXPECT_EQ(openGlErrors(), 0);
}

TEST(Corrections, ByTheMouseIn3dMoveAJointInThePlaneOfThePicture) {
  Desktop desk("view_joints_home");
  desk.openPhantom();
  desk.click("tab.anatomy");
  desk.click("anatomy.solid");
  desk.click("correct");

  // A rib is chosen by a click on it, where it stands free before the others.
  const Camera& camera = desk.app.camera();
  const std::vector<Vec3>& line = desk.results().anatomyValue()->rib(Side::left, 6)->centerline;
  const Vec3 shown = camera.project(line[line.size() * 9 / 10]);
  EXPECT_FALSE(desk.hand.sees("scene.junction"));
  desk.click("scene", float(shown.x), float(shown.y));
  ASSERT_TRUE(desk.hand.sees("scene.junction"));
  EXPECT_FALSE(desk.context().picked) << "the click means a rib and not the skin behind it";

  // Its end and its notch, drawn across the picture and down.
  desk.click("correct.notch");
  for (const std::string joint : {"junction", "notch"}) {
    const auto place = [&] {
      return joint == "notch" ? notchAt(*desk.results().anatomyValue(), Side::left, 6) : desk.results().anatomyValue()->rib(Side::left, 6)->centerline.back();
    };
    const Vec3 before = place();
    const auto skin = *desk.results().skin;
    const Camera stood = camera;
    const Vec3 at = camera.project(before);
    const ImVec2 from{float(at.x), float(at.y)}, to{from.x + 0.015f, from.y + 0.01f};
    desk.hand.frames(3);
    const auto seen = desk.target->pixels();
    const ImVec2 low = desk.hand.place("scene", 0, 0), high = desk.hand.place("scene", 1, 1);
    desk.hand.drag("scene", from, to);
    // While the anatomy is found anew, the chest stays to be seen: an empty scene differs by more than 5 grey levels.
    for (bool isFound = false; !isFound; isFound = !desk.context().activity.isBusy) {
      desk.hand.frames(1);
      EXPECT_LT(meanDifference(seen, desk.target->pixels(), 1280, {low.x, low.y, high.x - low.x, high.y - low.y}), 2.5);
    }
    desk.rest();
    ASSERT_EQ(desk.results().error, "");
    // The chest has not turned, and the joint stands where the mouse let it go, at the depth where it was: places of the mouse are whole
    // pixels, and a script has tenths of a millimetre.
    EXPECT_EQ(camera.matrix(), stood.matrix());
    const Vec3 after = place(), forward = normalized(camera.target - camera.eye());
    const double rounded = 0.05 * std::sqrt(3.0), pixel = std::sqrt(2.0) * distance(camera.onPlane(before, 0, 0), camera.onPlane(before, 0, 1)) / (high.y - low.y);
    EXPECT_NEAR(dot(after - before, forward), 0, rounded + 1e-9) << joint;
    EXPECT_LT(distance(after, camera.onPlane(before, to.x, to.y)), rounded + pixel) << joint;
    EXPECT_GT(distance(after, before), 3);
    EXPECT_NE(skin, *desk.results().skin);
    EXPECT_NE(scriptOf(desk.context().choices).find("joint = \"" + joint + "\""), std::string::npos) << scriptOf(desk.context().choices);

    // As in slices it is one step, back and forth.
    desk.hand.control('z');
    desk.rest();
    EXPECT_EQ(distance(place(), before), 0);
    EXPECT_EQ(skin, *desk.results().skin);
    desk.hand.control('y');
    desk.rest();
    EXPECT_EQ(distance(place(), after), 0);
  }
  EXPECT_EQ(desk.context().choices.corrections.size(), 2u);

  // A drag beside the joints turns the chest, and corrects nothing.
  const Camera stood = camera;
  desk.hand.drag("scene", {0.05f, 0.9f}, {0.15f, 0.9f});
  desk.rest();
  EXPECT_NE(camera.matrix(), stood.matrix());
  EXPECT_EQ(desk.context().choices.corrections.size(), 2u);

  // Other steps show the operation, with a click that tells of a point.
  desk.click("tab.bar");
  EXPECT_FALSE(desk.hand.sees("scene.junction"));
  EXPECT_EQ(desk.context().scene.part, 1);
  EXPECT_EQ(openGlErrors(), 0);
}

TEST(Corrections, ThatCannotBeMadeAreToldAndLeaveTheRest) {
  Desktop desk("view_refused_home");
  desk.openPhantom();
  addCorrection(desk.context().choices, ribDropped({Side::left, 8}));
  addCorrection(desk.context().choices, ribRenumbered({Side::left, 3}, 4));
  desk.context().changed(false);
  desk.rest();
  EXPECT_NE(desk.results().error.find("that number is taken"), std::string::npos) << desk.results().error;
  ASSERT_TRUE(desk.results().anatomyValue());
  EXPECT_EQ(desk.results().anatomyValue()->rib(Side::left, 8), nullptr);
  desk.click("undo");
  EXPECT_EQ(desk.results().error, "");
  EXPECT_TRUE(desk.results().motionValue());
}
