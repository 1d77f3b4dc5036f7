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
