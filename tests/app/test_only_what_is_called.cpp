// A plugin that a scene does not call costs nothing: valgrind counts the instructions of a run with and without it installed.
#include "tests/app/helpers.h"

namespace pectora {
namespace {

// Instructions of a run of `script` with one more folder of plugins; 0 if valgrind is not there.
double instructions(const std::filesystem::path& script, const std::filesystem::path& plugins, const std::filesystem::path& folder) {
  const std::string log = (folder / "valgrind.txt").string();
  const std::string command = "PECTORA_PLUGIN_PATH=" + plugins.string() + " valgrind --tool=callgrind --callgrind-out-file=/dev/null " PECTORA_PROGRAM
                              " run --threads 1 --quiet " + script.string() + " > " + (folder / "out.txt").string() + " 2> " + log;
  if (exitCode("command -v valgrind > /dev/null") != 0) return 0;
  EXPECT_EQ(exitCode(command), 0) << readFile(log);
  const std::string text = readFile(log), word = "Collected :";
  const std::size_t at = text.find(word);
  EXPECT_NE(at, std::string::npos) << text;
  return at == std::string::npos ? 0 : std::strtod(text.c_str() + at + word.size(), nullptr);
}

}  // namespace

TEST(OnlyWhatIsCalled, AnInstalledEffectThatNoSceneCallsCostsNoInstructions) {
  const std::filesystem::path folder = freshFolder("called"), none = folder / "none", more = folder / "more";
  std::filesystem::create_directories(none);
  std::filesystem::create_directories(more);
  std::filesystem::copy_file(std::filesystem::path(PECTORA_TEST_PLUGINS) / "effect.pull.so", more / "effect.pull.so");
  const std::filesystem::path script = folder / "solve.lua";
  std::ofstream(script) << "local case = model.hard_case{ name = 'contrast_1e-3', size = 15 }\n"
                           "local m = solver.verlet(case.scene, case.plan, { max_iterations = 400, accept_unconverged = true })\n"
                           "print(m.status, m.iterations)\n";
  const double without = instructions(script, none, folder), with = instructions(script, more, folder);
  if (without == 0) GTEST_SKIP() << "valgrind is not installed";
  EXPECT_NE(readFile(folder / "out.txt"), "");
  EXPECT_NEAR(with / without, 1, 1e-3) << without << " and " << with << " instructions";
}

}  // namespace pectora
