// What a desktop does to the window: paths are dropped on it, and mostly nothing happens.
#include "tests/app/view/desk.h"
#include "tests/app/view/xvfb.h"

#include "app/view/session/script_text.h"

#include <atomic>
#include <thread>

using namespace pectora;
using namespace pectora::view;

TEST(Drop, OpensAFolderOfDicomAScanAScriptAndAResult) {
  Desktop desk("view_drop_home");
  // A phantom's folder as a user has it.
  const std::string folder = desk.home + "/patient";
  const std::string command = "cd " + desk.home + " && " PECTORA_PROGRAM " run --quiet " PECTORA_SOURCE "/scripts/phantom.lua matrix=128 slice_spacing=5 out=patient > out.txt 2>&1";
  ASSERT_EQ(exitCode(command), 0) << readFile(desk.home + "/out.txt");
  desk.rest();
  makeCoarse(desk.context().choices);
  const auto drop = [&](const std::string& path) {
    desk.target->drop({path});
    desk.hand.frames(2);
    desk.rest();
  };

  drop(folder + "/dicom/");
  EXPECT_EQ(desk.context().choices.source, Source::dicom);
  ASSERT_TRUE(desk.results().motionValue()) << desk.results().error << desk.context().message;
  EXPECT_FALSE(desk.results().scan.value);

  drop(folder + "/truth/scan.ply");
  EXPECT_TRUE(desk.results().scan.value) << desk.results().error;
  EXPECT_EQ(desk.context().tab, Tab::compare);

  // A script that lifts by 17 mm.
  Choices wanted = desk.context().choices;
  assign(wanted.planner.settings, "lift", 17.0);
  std::ofstream(desk.home + "/mine.lua") << scriptOf(wanted);
  drop(desk.home + "/mine.lua");
  ASSERT_TRUE(desk.results().planValue());
  EXPECT_EQ(desk.results().planValue()->lift(), 17) << desk.told();

  // Its results, written and dropped; and what is nothing is told.
  const std::string result = desk.home + "/result";
  desk.context().worker().run("export", [&](Pipeline& pipeline) { pipeline.exportTo(result); });
  desk.rest();
  drop(result);
  EXPECT_EQ(desk.context().choices.source, Source::result);
  EXPECT_TRUE(Results::as<Mesh>(desk.results().after)) << desk.results().error;
  drop(desk.home + "/nowhere");
  EXPECT_NE(desk.context().message.find("There is nothing at"), std::string::npos);
  EXPECT_EQ(openGlErrors(), 0);
}

TEST(Idle, NothingAsksForAFrameAndNothingWakesTheWindow) {
  ownHome("view_idle_home");
  Xvfb display(1280, 800);
  if (!display.isThere()) GTEST_SKIP() << "Xvfb or xdotool is not installed (third_party/install.sh does)";
  const ImGuiHolder imgui;
  const auto target = makeWindow(1280, 800, 1);
  Registry registry({PECTORA_PLUGINS});
  std::atomic<int> wakes{0};
  App app(*target, registry, [&] { ++wakes, wakeWindow(); });
  DisplayHand hand(app, *target);
  ASSERT_TRUE(hand.rest(kPatience));
  makeCoarse(app.context().choices);
  hand.click("opening.phantom");
  ASSERT_TRUE(hand.rest(kPatience));
  ASSERT_TRUE(app.context().results->motionValue());
  // What the display still has to tell, it tells now: until nothing has come for two seconds.
  using Clock = std::chrono::steady_clock;
  int frames = 0;
  for (auto start = Clock::now(); target->wait(app.wantsFrame() ? 0 : 2), Clock::now() - start < std::chrono::seconds(2); start = Clock::now(), ++frames) {
    app.frame();
    ASSERT_LT(frames, 1000) << "it never comes to rest";
  }

  // The program draws a frame when the wait for something to happen ends: here not before it is woken on purpose.
  const int wakesBefore = wakes;
  std::atomic<bool> isWoken{false};
  std::thread waker([&] {
    std::this_thread::sleep_for(std::chrono::seconds(1));
    isWoken = true;
    wakeWindow();
  });
  const bool isOpen = target->wait(1e9);
  EXPECT_TRUE(isWoken) << "a frame was drawn although nothing had happened";
  waker.join();
  EXPECT_TRUE(isOpen);
  EXPECT_EQ(wakes, wakesBefore);
  EXPECT_FALSE(app.wantsFrame());
}
