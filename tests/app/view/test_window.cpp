// The whole window, worked by a hand as a user would: on a framebuffer without a display, and as a real window under Xvfb.
#include "tests/app/view/walk.h"
#include "tests/app/view/xvfb.h"

#include "tests/app/helpers.h"

using namespace pectora;
using namespace pectora::view;

namespace {

// The program with a window of its own. Where leaks are looked for, the walk finds ours; when a program ends, the driver is no longer
// mapped, and its own could not be told from them.
constexpr const char* kProgram = "ASAN_OPTIONS=detect_leaks=0 timeout 500 " PECTORA_PROGRAM " view";

// Taken once, for all tests of this run.
const Walk& walkOffscreen(const std::string& folder) {
  static Walk walk;
  if (walk.width > 0) return walk;
  const ImGuiHolder imgui;
  const auto target = makeOffscreen(1280, 800, 1);
  Registry registry({PECTORA_PLUGINS});
  App app(*target, registry, [] {});
  Hand hand(app);
  return walk = walkThrough(app, hand, *target, folder);
}

}  // namespace

TEST(Window, DoesWhatTheHandDoesAndLeavesNothingBehind) {
  const std::string home = ownHome("view_home");
  {
    const Walk& walk = walkOffscreen(home);
    // A chest is to be seen, and the bar's way and the distances change the picture by more than edges do.
    EXPECT_GT(meanDifference(walk.empty, walk.opened, walk.width, walk.scene), 5);
    EXPECT_GT(meanDifference(walk.opened, walk.sawDistances, walk.width, walk.scene), 5);
  }
  EXPECT_EQ(liveGpuObjects(), 0);
}

TEST(Window, PicksAPointAndTellsItsSprings) {
  ownHome("view_pick_home");
  const ImGuiHolder imgui;
  const auto target = makeOffscreen(1280, 800, 1);
  Registry registry({PECTORA_PLUGINS});
  App app(*target, registry, [] {});
  Hand hand(app);
  ASSERT_TRUE(hand.rest(500));
  app.context().choices.loader = {"loader.phantom", {{"matrix", 128.0}, {"slice_spacing", 5.0}}};
  assign(app.context().choices.model.settings, "spacing", 14.0);
  hand.click("opening.phantom");
  ASSERT_TRUE(hand.rest(500));
  hand.click("tab.tissue");
  ASSERT_TRUE(hand.rest(500));
  const Scene& scene = *app.context().results->sceneValue();
  const Vec3 at = app.camera().project((*app.context().results->skin)[scene.index(scene.rows / 2, scene.columns / 2)]);
  hand.click("scene", float(at.x), float(at.y));
  ASSERT_TRUE(hand.rest(500));
  ASSERT_TRUE(app.context().picked);
  EXPECT_FALSE(app.context().picked->springs.empty());
}

TEST(Window, IsTheSameOnARealDisplayWorkedByMouseAndKeyboard) {
  const std::string home = ownHome("view_display_home");
  Xvfb display(1280, 800);
  if (!display.isThere()) GTEST_SKIP() << "Xvfb or xdotool is not installed (third_party/install.sh does)";
  const Walk& without = walkOffscreen(home + "/offscreen");
  Walk with;
  {
    const ImGuiHolder imgui;
    const auto target = makeWindow(1280, 800, 1);
    Registry registry({PECTORA_PLUGINS});
    App app(*target, registry, [] { wakeWindow(); });
    DisplayHand hand(app, *target);
    with = walkThrough(app, hand, *target, home + "/display");
    // At rest nothing asks for another frame.
    EXPECT_FALSE(app.wantsFrame());
  }
  EXPECT_EQ(liveGpuObjects(), 0);
  // The same deeds give the same plan: mouse positions are whole pixels, of about 0.5 mm here, and settings have one decimal.
  EXPECT_NEAR(with.lift, without.lift, 1.0);
  EXPECT_NEAR(with.level, without.level, 1.0);
  // And the same pictures: both are drawn in software, and only edges may fall on another side of a pixel.
  ASSERT_EQ(with.width, without.width);
  for (const auto& [a, b] : {std::pair{&with.opened, &without.opened}, std::pair{&with.sawDistances, &without.sawDistances}}) {
    EXPECT_LT(meanDifference(*a, *b, with.width, with.scene), 1);
    const auto x = meanColor(*a, with.width, with.scene), y = meanColor(*b, with.width, with.scene);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(x[c], y[c], 0.5);
  }
  EXPECT_GT(meanDifference(with.empty, with.opened, with.width, with.scene), 5);
}

TEST(Window, ProgramOpensOneAndEndsWhenItIsClosed) {
  const std::string home = ownHome("view_program_home");
  Xvfb display(1280, 800);
  if (!display.isThere()) GTEST_SKIP() << "Xvfb or xdotool is not installed (third_party/install.sh does)";
  // Ctrl+Q goes to the window when there is one, and again until it is closed.
  const std::string command = std::string(kProgram) + " > " + home + "/out.txt 2>&1 & program=$!; "
                              "timeout 400 xdotool search --sync --onlyvisible --name '^Pectora$' mousemove 640 400 > /dev/null; "
                              "while kill -0 $program 2> /dev/null; do xdotool key --clearmodifiers ctrl+q; sleep 0.5; done; wait $program";
  EXPECT_EQ(exitCode(command), 0) << readFile(home + "/out.txt");
}

TEST(Window, ProgramSaysWhatToDoWithoutOpenGl33) {
  const std::string home = ownHome("view_old_home");
  Xvfb display(1280, 800);
  if (!display.isThere()) GTEST_SKIP() << "Xvfb or xdotool is not installed (third_party/install.sh does)";
  // Mesa can be told to be an older one.
  const std::string command = std::string("MESA_GL_VERSION_OVERRIDE=2.1 ") + kProgram + " > " + home + "/out.txt 2>&1";
  EXPECT_EQ(exitCode(command), 2);
  const std::string told = readFile(home + "/out.txt");
  EXPECT_NE(told.find("OpenGL 3.3"), std::string::npos) << told;
  EXPECT_NE(told.find("Install a driver"), std::string::npos) << told;
}

TEST(Window, ProgramSaysWhatToDoWithoutADisplay) {
  const std::string home = ownHome("view_without_home");
  const std::string command = "env -u DISPLAY -u WAYLAND_DISPLAY " PECTORA_PROGRAM " view > " + home + "/out.txt 2>&1";
  EXPECT_EQ(exitCode(command), 2);
  EXPECT_NE(readFile(home + "/out.txt").find("no display can be opened"), std::string::npos) << readFile(home + "/out.txt");
}
