// What the window tells: tooltips, the line below, and where files are.
#include "tests/app/view/desk.h"

#include "app/view/panels/scene_parts.h"
#include "app/view/panels/widgets.h"

using namespace pectora;
using namespace pectora::view;

TEST(Tooltips, WaitForTheMouseToRestAndGoWhenItIsPressed) {
  Desktop desk("view_tooltip_home");
  desk.rest();
  const ImVec2 low = desk.hand.place("screenshot", 0.3f, 0.5f), high = desk.hand.place("screenshot", 0.7f, 0.5f);
  // Frames are 1/60 s apart without a display. A mouse that moves is told nothing.
  ImVec2& mouse = ImGui::GetIO().MousePos;
  for (int i = 0; i < 60; ++i) {
    mouse = {low.x + (high.x - low.x) * float(i) / 60, low.y};
    desk.hand.frames(1);
    EXPECT_FALSE(desk.hand.sees("tooltip")) << i;
  }
  EXPECT_LT(desk.app.untilFrame(), 0.5) << "a window that rests must draw it when it is due";
  desk.hand.frames(40);
  EXPECT_TRUE(desk.hand.sees("tooltip"));
  desk.rest();
  EXPECT_EQ(desk.app.untilFrame(), 1e9) << "and then nothing more";
  // Pressed, it goes, and does not come again before the mouse has left.
  ImGui::GetIO().MouseDown[0] = true;
  desk.hand.frames(2);
  ImGui::GetIO().MouseDown[0] = false;
  desk.hand.frames(60);
  EXPECT_FALSE(desk.hand.sees("tooltip"));
  mouse = {-1, -1};
  desk.hand.frames(3);
  mouse = low;
  desk.hand.frames(60);
  EXPECT_TRUE(desk.hand.sees("tooltip"));
}

TEST(StatusLine, CutsALongErrorBeforeWhatStandsBesideIt) {
  Desktop desk("view_status_home");
  desk.rest();
  const auto picture = [&](const std::string& message) {
    desk.context().message = message;
    ImGui::GetIO().MousePos = {-1, -1};
    desk.hand.frames(2);
    return desk.target->pixels();
  };
  const auto quiet = picture("");
  std::string told;
  for (int i = 0; i < 100; ++i) told += "wörter ";   // letters of one byte and of two
  for (int more = 0; more < 3; ++more, told += "x") {
    const auto loud = picture(told);
    // The last 21 em belong to "Research software, not a medical device".
    EXPECT_EQ(meanDifference(quiet, loud, 1280, {1280 - 21 * 14, 765, 21 * 14, 35}), 0);
    EXPECT_GT(meanDifference(quiet, loud, 1280, {0, 765, 900, 35}), 3);
  }
}

TEST(Files, AScreenshotShowsTheStepThatIsOpenAndReplacesNoOther) {
  Desktop desk("view_files_home");
  desk.openPhantom();
  desk.context().outFolder = desk.home + "/pictures";
  for (const char* tab : {"tab.bar", "tab.anatomy"}) {
    desk.click(tab);
    desk.click("screenshot");
  }
  EXPECT_TRUE(std::filesystem::exists(desk.home + "/pictures/screenshot.png"));
  EXPECT_TRUE(std::filesystem::exists(desk.home + "/pictures/screenshot_2.png"));
  EXPECT_NE(desk.context().notice.find("screenshot_2.png"), std::string::npos) << "where it is, is told";

  // A turntable, which is asked for under Script, shows the scene as it was seen last.
  desk.click("tab.tissue");
  EXPECT_EQ(desk.context().scene.skin, SkinLook::displacement);
  desk.click("tab.script");
  EXPECT_EQ(desk.context().scene.skin, SkinLook::displacement);

  // Springs stand where they pull: after the operation, not on the way there.
  desk.click("tab.patient");
  desk.hand.click("scene", 0.5f, 0.5f);
  desk.rest();
  ASSERT_TRUE(desk.context().picked && desk.context().picked->isKnown);
  SceneParts parts;
  const auto drawn = [&](float part) {
    desk.context().scene.part = part;
    parts.update(desk.context());
    return parts.items(desk.context()).size();
  };
  const std::size_t after = drawn(1);
  EXPECT_EQ(drawn(0.5f), after - 1);
}

TEST(Sliders, ShowAllDigitsThatAValueHas) {
  Desktop desk("view_digits_home");
  desk.openPhantom();
  desk.click("tab.bar");
  const auto slider = [&](double lift) {
    assign(desk.context().choices.planner.settings, "lift", lift);
    ImGui::GetIO().MousePos = {-1, -1};
    desk.hand.frames(2);
    return desk.target->pixels();
  };
  const auto whole = slider(25), near = slider(24.9), same = slider(25);
  // The grab moves by 1/1000 of the slider; the figure is another.
  const ImVec2 low = desk.hand.place("bar.lift", 0.3f, 0), high = desk.hand.place("bar.lift", 0.7f, 1);
  const ImVec4 figure{low.x, low.y, high.x - low.x, high.y - low.y};
  EXPECT_GT(meanDifference(whole, near, 1280, figure), 2);
  EXPECT_EQ(meanDifference(whole, same, 1280, figure), 0);
}
