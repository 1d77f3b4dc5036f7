// What the user chose, its undo, and its script.
#include "app/view/session/choices.h"
#include "app/view/session/script_text.h"

#include "kernel/script/engine.h"
#include "tests/app/helpers.h"

using namespace pectora;
using namespace pectora::view;

namespace {

Choices someChoices() {
  Choices c = initialChoices({"solver.lbfgs", "solver.newton", "solver.verlet"});
  c.source = Source::phantom;
  c.loader = {"loader.phantom", {{"matrix", 128.0}, {"type", std::string("saucer")}}};
  return c;
}

}  // namespace

TEST(Choices, BeginWithTheFastestSolverThatThereIs) {
  EXPECT_EQ(initialChoices({"solver.lbfgs", "solver.newton"}).solver.id, "solver.newton");
  EXPECT_EQ(initialChoices({"solver.lbfgs", "solver.multigrid"}).solver.id, "solver.lbfgs");
  EXPECT_EQ(initialChoices({"solver.verlet"}).solver.id, "solver.verlet");
}

TEST(Choices, TellTheFirstStepThatDiffers) {
  const Choices a = someChoices();
  Choices b = a;
  EXPECT_EQ(firstDifference(a, b), Step::nothing);
  b.usesIcp = false;
  EXPECT_EQ(firstDifference(a, b), Step::registration);
  assign(b.solver.settings, "tolerance", 1e-3);
  EXPECT_EQ(firstDifference(a, b), Step::motion);
  assign(b.planner.settings, "lift", 20.0);
  EXPECT_EQ(firstDifference(a, b), Step::plan);
  b.effects[2].isOn = false;
  EXPECT_EQ(firstDifference(a, b), Step::scene);
  assign(b.loader.settings, "haller", 5.0);
  EXPECT_EQ(firstDifference(a, b), Step::source);
}

TEST(History, GoesBackAndForthAndForgetsWhatWasLeft) {
  Choices c = someChoices();
  History history;
  history.begin(c);
  history.keep(c);
  EXPECT_FALSE(history.canUndo()) << "nothing has changed";
  for (double lift : {10.0, 20.0}) assign(c.planner.settings, "lift", lift), history.keep(c);
  EXPECT_EQ(std::get<double>(*find(history.undo().planner.settings, "lift")), 10);
  EXPECT_EQ(find(history.undo().planner.settings, "lift"), nullptr);
  EXPECT_FALSE(history.canUndo());
  EXPECT_EQ(std::get<double>(*find(history.redo().planner.settings, "lift")), 10);
  assign(c.planner.settings, "lift", 5.0);
  history.keep(c);
  EXPECT_FALSE(history.canRedo());
}

TEST(ScriptText, IsRunByThePectoraProgramAsItStands) {
  Choices c = someChoices();
  assign(c.model.settings, "spacing", 14.0);
  assign(c.planner.settings, "lift", 12.5);
  c.effects.push_back({{"effect.bend", {{"stiffness", 0.25}}}, false});
  const std::filesystem::path folder = freshFolder("view_script");
  std::ofstream(folder / "session.lua") << scriptOf(c);
  const std::string command = "cd " + folder.string() + " && " PECTORA_PROGRAM " run --quiet session.lua > out.txt 2> err.txt";
  ASSERT_EQ(exitCode(command), 0) << readFile(folder / "err.txt") << scriptOf(c);
  EXPECT_NE(readFile(folder / "out.txt").find("lift = 12.5 mm"), std::string::npos) << readFile(folder / "out.txt");
  EXPECT_TRUE(std::filesystem::exists(folder / "result/summary.json"));
  EXPECT_TRUE(std::filesystem::exists(folder / "result/scan_vs_simulated.png"));
}

TEST(ScriptText, QuotesWhatAPathMayHold) {
  Choices c = someChoices();
  c.source = Source::dicom;
  c.loader = {"loader.dicom", {{"path", std::string("a \"b\"\\c")}}};
  EXPECT_NE(scriptOf(c).find(R"(path = "a \"b\"\\c")"), std::string::npos) << scriptOf(c);
}
