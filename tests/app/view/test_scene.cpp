// The scene in 3-D: what its tools show, and that they change nothing that is computed.
#include "tests/app/view/desk.h"

#include "app/view/session/script_text.h"

using namespace pectora;
using namespace pectora::view;

namespace {

struct SceneDesk : Desktop {
  using Desktop::Desktop;
  std::vector<unsigned char> picture() {
    ImGui::GetIO().MousePos = {-1, -1};
    rest();
    return target->pixels();
  }
  // In grey levels, over the scene without the colour bar's corner.
  double change(const std::vector<unsigned char>& from, const std::vector<unsigned char>& to) {
    const ImVec2 low = hand.place("scene", 0, 0.3f), high = hand.place("scene", 1, 1);
    return meanDifference(from, to, 1280, {low.x, low.y, high.x - low.x, high.y - low.y});
  }
};

}  // namespace

TEST(SceneTools, CutTheChestOpenAndCloseItAgain) {
  SceneDesk desk("view_clip_home");
  desk.openPhantom();
  const auto whole = desk.picture();
  desk.click("show");
  desk.click("show.clip");
  EXPECT_TRUE(desk.context().scene.clip.isOn);
  // With nothing cut off, and with the left half.
  desk.click("clip.at", 0.02f, 0.5f);
  const auto few = desk.picture();
  desk.click("clip.at", 0.5f, 0.5f);
  EXPECT_GT(desk.change(few, desk.picture()), 3);
  desk.click("show.clip");
  desk.hand.click("scene", 0.01f, 0.99f);   // closes the menu
  EXPECT_LT(desk.change(whole, desk.picture()), 0.01);
  EXPECT_EQ(openGlErrors(), 0);
}

TEST(SceneTools, GoFromBeforeToAfterAndBack) {
  SceneDesk desk("view_part_home");
  desk.openPhantom();
  const auto after = desk.picture();
  desk.click("part", 0.001f, 0.5f);
  EXPECT_EQ(desk.context().scene.part, 0);
  const auto before = desk.picture();
  EXPECT_GT(desk.change(after, before), 1);
  desk.hand.drag("part", {0.001f, 0.5f}, {0.5f, 0.5f});
  EXPECT_NEAR(desk.context().scene.part, 0.5, 0.02);
  const auto between = desk.picture();
  EXPECT_GT(desk.change(before, between), 0.3);
  EXPECT_GT(desk.change(after, between), 0.3);
  desk.click("part", 0.999f, 0.5f);
  EXPECT_LT(desk.change(after, desk.picture()), 0.01);
  EXPECT_EQ(openGlErrors(), 0);
}

TEST(SceneTools, FixTheColourBarByHandAndFreeIt) {
  SceneDesk desk("view_range_home");
  desk.openPhantom();
  desk.click("tab.tissue");
  const auto free = desk.picture();
  desk.click("colorbar");
  EXPECT_FALSE(desk.context().picked) << "the click means no point behind the bar";
  desk.click("range", 0.9f, 0.5f);
  EXPECT_TRUE(desk.context().scene.isRangeFixed);
  EXPECT_GT(desk.context().scene.range, 40);
  EXPECT_GT(desk.change(free, desk.picture()), 3);
  desk.click("range.fix");
  EXPECT_FALSE(desk.context().scene.isRangeFixed);
  desk.hand.click("scene", 0.01f, 0.99f);
  EXPECT_LT(desk.change(free, desk.picture()), 0.01);
  EXPECT_EQ(openGlErrors(), 0);
}

TEST(SceneTools, PutAPatientOpenedBeforeOnTheRecentList) {
  std::string script;
  {
    SceneDesk desk("view_recent_home");
    desk.openPhantom();
    Choices wanted = desk.context().choices;
    assign(wanted.planner.settings, "lift", 17.0);
    script = desk.home + "/mine.lua";
    std::ofstream(script) << scriptOf(wanted);
    desk.context().open(script);
    desk.rest();
    ASSERT_TRUE(desk.results().planValue());
    EXPECT_EQ(desk.results().planValue()->lift(), 17) << desk.told();
  }
  // Another window has it in its list, and opens it by a click.
  const RecentFiles kept;
  ASSERT_FALSE(kept.paths().empty());
  EXPECT_EQ(kept.paths().front(), script);
  const ImGuiHolder imgui;
  const auto target = makeOffscreen(1280, 800, 1);
  Registry registry({PECTORA_PLUGINS});
  App app(*target, registry, [] {});
  Hand hand(app);
  ASSERT_TRUE(hand.rest(kPatience));
  hand.click("recent.mine.lua");
  ASSERT_TRUE(hand.rest(kPatience));
  ASSERT_TRUE(app.context().results->planValue()) << app.context().results->error;
  EXPECT_EQ(app.context().results->planValue()->lift(), 17);
}
