// scripts/stability.lua: no solver breaks the rule of any case, and of scenes drawn from seeds.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace {

// Runs the script; on failure the lines with broken rules are told.
void expectNoneBroken(const std::string& arguments) {
  const std::string table = testing::TempDir() + "pectora_stability_" + std::to_string(std::hash<std::string>{}(arguments)) + ".txt";
  const std::string command = std::string(PECTORA_PROGRAM) + " run " + PECTORA_SOURCE + "/scripts/stability.lua brief=true " + arguments + " > " + table + " 2>&1";
  const int code = std::system(command.c_str());
  std::ifstream file(table);
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_EQ(code, 0) << command << "\n" << text.str();
  EXPECT_NE(text.str().find(" 0 broke their rule"), std::string::npos) << text.str();
}

class Stability : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Solver, Stability, testing::Values("verlet", "semi_implicit", "implicit", "newton", "lbfgs", "projective", "multigrid", "xpbd"),
                         [](const auto& p) { return std::string(p.param); });

}  // namespace

TEST_P(Stability, HoldsInEveryHardCase) { expectNoneBroken("quick=true solver=" + std::string(GetParam())); }
TEST_P(Stability, HoldsInScenesDrawnFromSeeds) { expectNoneBroken("only=random seed=1 scenes=12 solver=" + std::string(GetParam())); }
