// The whole window on a framebuffer without a display, worked by a hand as a user would.
#include "app/view/hand.h"

#include "kernel/stage/error.h"
#include "tests/app/helpers.h"

using namespace pectora;
using namespace pectora::view;

namespace {

double brightness(const std::vector<unsigned char>& rgba) {
  double sum = 0;
  for (std::size_t i = 0; i < rgba.size(); i += 4) sum += rgba[i] + rgba[i + 1] + rgba[i + 2];
  return sum / (0.75 * double(rgba.size()));
}

}  // namespace

TEST(Window, OpensAPhantomMovesTheBarUndoesAndLeavesNothingBehind) {
  // A home of its own: the user's recent files are none of a test's business.
  const std::string home = freshFolder("view_home").string();
  setenv("XDG_STATE_HOME", home.c_str(), 1);
  setenv("XDG_CONFIG_HOME", home.c_str(), 1);
  {
    const ImGuiHolder imgui;
    const auto target = makeOffscreen(1280, 800, 1);
    Registry registry({PECTORA_PLUGINS});
    App app(*target, registry, [] {});
    Hand hand(app);
    ASSERT_TRUE(hand.rest());
    const double empty = brightness(target->pixels());
    assign(app.context().choices.model.settings, "spacing", 14.0);
    hand.click("opening.phantom");
    ASSERT_TRUE(hand.rest());
    ASSERT_TRUE(app.context().results->motionValue()) << app.context().results->error;
    EXPECT_GT(brightness(target->pixels()), empty + 5) << "a chest is to be seen";

    // The bar's lift by its slider: another skin, and undo brings the first one back.
    hand.click("tab.bar");
    hand.frames(3);
    const auto first = app.context().results->motionValue()->outer;
    hand.drag("bar.lift", {0.5f, 0.5f}, {0.35f, 0.5f});
    ASSERT_TRUE(hand.rest());
    const Plan* lower = app.context().results->planValue();
    EXPECT_LT(lower->lift, 30);
    EXPECT_NE(app.context().results->motionValue()->outer.front(), Vec3{});
    hand.click("undo");
    ASSERT_TRUE(hand.rest());
    EXPECT_EQ(app.context().results->planValue()->lift, 30);
    EXPECT_EQ(app.context().results->motionValue()->outer, first) << "settled skins are the script's, whatever came before";

    // A click on the skin tells about a point; a picture is written.
    hand.click("tab.tissue");
    hand.frames(3);
    hand.click("scene", 0.5f, 0.45f);
    ASSERT_TRUE(hand.rest());
    ASSERT_TRUE(app.context().picked);
    EXPECT_FALSE(app.context().picked->springs.empty());
    app.savePicture(home + "/picture.png");
    EXPECT_GT(std::filesystem::file_size(home + "/picture.png"), 20000u);
    EXPECT_EQ(openGlErrors(), 0);
  }
  EXPECT_EQ(liveGpuObjects(), 0);
}
