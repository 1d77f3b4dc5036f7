// What is seen of a solver that is slower than the hand, and how it is stopped.
#include "tests/app/view/desk.h"

using namespace pectora;
using namespace pectora::view;

namespace {

using Clock = std::chrono::steady_clock;

// A phantom whose skin creeps forward for ever once something is moved.
struct SlowDesktop : Desktop {
  explicit SlowDesktop(const std::string& name) : Desktop(name, 1280, 800, 1, {PECTORA_PLUGINS, PECTORA_VIEW_TEST_PLUGINS}) {
    context().choices.solver = {"solver.creep"};
    openPhantom();
  }
  void dragTo(double lift) {
    assign(context().choices.planner.settings, "lift", lift);
    context().changed(true);
  }
  // Draws frames until something holds; false if it never does.
  bool framesUntil(const std::function<bool()>& holds) {
    for (const auto start = Clock::now(); Clock::now() - start < std::chrono::duration<double>(kPatience);) {
      hand.frames(1);
      if (holds()) return true;
    }
    return false;
  }
};

}  // namespace

TEST(Following, ShowsTheWayOfASlowSolverAndStopsItWithinAStepWhenTheHandMovesOn) {
  SlowDesktop desk("view_following_home");
  const auto atRest = desk.target->pixels();
  desk.dragTo(31);
  std::vector<std::shared_ptr<const std::vector<Vec3>>> seen;
  const auto seesAnother = [&] {
    const auto skin = desk.results().isPreview ? desk.results().skin : nullptr;
    if (skin && (seen.empty() || seen.back() != skin)) seen.push_back(skin);
    return seen.size() == 5;
  };
  ASSERT_TRUE(desk.framesUntil(seesAnother)) << "five states of one solve that never ends";
  for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_GE((*seen[i - 1])[0].y, (*seen[i])[0].y + 0.99) << "a step on, or some";
  const ImVec2 low = desk.hand.place("scene", 0, 0), high = desk.hand.place("scene", 1, 1);
  EXPECT_GT(meanDifference(atRest, desk.target->pixels(), 1280, {low.x, low.y, high.x - low.x, high.y - low.y}), 0.5) << "and seen on the screen";

  // The next movement: what is logged after the wish and before the next solve begins are steps too many.
  desk.dragTo(32);
  desk.context().worker().log(LogLine::Kind::print, "wished");
  int stepsTooMany = 0;
  const auto& log = desk.context().log;
  const auto beginsAgain = [&] {
    const auto wish = std::find_if(log.begin(), log.end(), [](const LogLine& line) { return line.text == "wished"; });
    const auto next = std::find_if(wish, log.end(), [](const LogLine& line) { return line.text == "solver.creep: begins"; });
    if (next == log.end()) return false;
    stepsTooMany = int(std::count_if(wish, next, [](const LogLine& line) { return line.text == "solver.creep: steps"; }));
    return true;
  };
  ASSERT_TRUE(desk.framesUntil(beginsAgain)) << desk.told();
  EXPECT_LE(stepsTooMany, 1) << "one may have begun in the same moment";

  // It goes on from where it was seen last, not from the beginning.
  seen.clear();
  const double before = (*desk.results().skin)[0].y;
  ASSERT_TRUE(desk.framesUntil([&] { return seesAnother() || !seen.empty(); }));
  EXPECT_LE((*seen.back())[0].y, before);
}

TEST(Following, OfASlowSolverCanBeCancelledAndGoneOnWith) {
  SlowDesktop desk("view_stopped_home");
  desk.dragTo(31);
  ASSERT_TRUE(desk.framesUntil([&] { return desk.hand.sees("cancel"); }));
  desk.click("cancel");
  EXPECT_FALSE(desk.context().activity.isBusy);
  ASSERT_TRUE(desk.framesUntil([&] { return desk.hand.sees("resume"); })) << "what is shown has not come to rest, and that is told";
  const auto stopped = desk.results().skin;
  desk.hand.click("resume");
  ASSERT_TRUE(desk.framesUntil([&] { return desk.results().skin != stopped; }));
}

TEST(Following, AHandThatIsFasterThanTheSolverStillSeesItComeNearer) {
  SlowDesktop desk("view_hasty_home");
  const double before = (*desk.results().skin)[0].y;
  // A wish with every frame, and each cancels the solve before it.
  double lift = 30;
  ASSERT_TRUE(desk.framesUntil([&] {
    desk.dragTo(lift = lift < 40 ? lift + 0.1 : 30);
    return (*desk.results().skin)[0].y < before - 4;
  })) << "some steps were kept";
}
