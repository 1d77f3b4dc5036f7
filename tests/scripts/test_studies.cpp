// The studies of solvers and of accuracy, as a user runs them, in their small form.
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace fs = std::filesystem;

namespace {

struct Ended {
  int code = -1;
  std::string text;
};

Ended run(const std::string& script, const std::string& arguments) {
  const fs::path out = pectora::scratch(fs::path(script).stem().string() + ".txt");
  const std::string command = std::string(PECTORA_PROGRAM) + " run " + PECTORA_SOURCE + "/" + script + " " + arguments + " > " + out.string() + " 2> /dev/null";
  Ended result;
  result.code = std::system(command.c_str());
  std::ostringstream text;
  text << std::ifstream(out).rdbuf();
  result.text = text.str();
  fs::remove(out);
  return result;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

}  // namespace

TEST(SwapScript, BringsEverySolverToRest) {
  const Ended swap = run("scripts/swap.lua", "matrix=128 lift=15 spacing=16");
  EXPECT_EQ(swap.code, 0) << swap.text;
  EXPECT_EQ(count(swap.text, "converged"), 9u) << swap.text;
}

TEST(SwingScript, TellsTheWayInTimeAndWritesIt) {
  const fs::path out = pectora::scratch("swing");
  fs::remove_all(out);
  const Ended swing = run("scripts/swing.lua", "matrix=128 lift=15 spacing=16 duration=0.1 lifting=0.05 out=" + out.string());
  EXPECT_EQ(swing.code, 0) << swing.text;
  EXPECT_EQ(count(swing.text, " converged"), 11u) << swing.text;
  // A row for each of the moments 0, 0.02 ... 0.1 s, and the skin at each.
  std::ostringstream table, series;
  table << std::ifstream(out / "course.csv").rdbuf();
  series << std::ifstream(out / "course.pvd").rdbuf();
  EXPECT_EQ(count(table.str(), "\n"), 7u) << table.str();
  EXPECT_EQ(count(table.str(), "\n0.1,"), 1u) << table.str();
  EXPECT_EQ(count(series.str(), "<DataSet "), 6u);
  for (const char* file : {"course/skin_0000.vtp", "course/skin_0005.vtp"}) {
    EXPECT_TRUE(fs::exists(out / file)) << file;
    EXPECT_EQ(count(series.str(), file), 1u);
  }
  fs::remove_all(out);
}

TEST(AccuracyScript, WritesTheTableAndThePicturesOfEverySolver) {
  const fs::path out = pectora::scratch("accuracy");
  fs::remove_all(out);
  const Ended study = run("scripts/accuracy.lua", "quick=true runs=1 out=" + out.string());
  EXPECT_EQ(study.code, 0) << study.text;
  for (const char* file : {"accuracy.csv", "accuracy.json", "solver_error.png", "total_error.png"}) EXPECT_TRUE(fs::exists(out / file)) << file;
  std::ostringstream table;
  table << std::ifstream(out / "accuracy.csv").rdbuf();
  for (const char* solver : {"verlet", "semi_implicit", "implicit", "newton", "lbfgs", "multigrid", "projective", "xpbd"})
    EXPECT_GT(count(table.str(), std::string(",") + solver + ","), 0u) << solver;
  fs::remove_all(out);
}

TEST(AnatomyStudy, WritesTableAndPicture) {
  const fs::path out = pectora::scratch("anatomy_study");
  fs::remove_all(out);
  const Ended study = run("scripts/anatomy_study.lua", "matrix=192 only=cup_4 out=" + out.string());
  EXPECT_EQ(study.code, 0) << study.text;
  EXPECT_EQ(count(study.text, "cup_4 "), 1u) << study.text;
  for (const char* file : {"anatomy_study.csv", "anatomy_study.png"}) EXPECT_TRUE(fs::exists(out / file)) << file;
  EXPECT_NE(run("scripts/anatomy_study.lua", "only=nobody out=" + out.string()).code, 0);
  fs::remove_all(out);
}

TEST(Accuracy, PromisedIsKeptOnPhantomsThatWereNotStudied) {
  const Ended promise = run("tests/scripts/accuracy_promise.lua", "");
  EXPECT_EQ(promise.code, 0) << promise.text;
  EXPECT_EQ(count(promise.text, "kept"), 4u) << promise.text;
}
