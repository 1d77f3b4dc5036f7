// What the README shows must work: its plugin is built as it stands, outside of the tree, and used by name.
#include "tests/app/helpers.h"

#include <algorithm>

namespace fs = std::filesystem;
using namespace pectora;

namespace {

// The first code block of a language.
std::string codeBlock(const std::string& text, const std::string& language) {
  const std::string fence = "```" + language + "\n";
  const std::size_t begin = text.find(fence) + fence.size();
  return text.substr(begin, text.find("```", begin) - begin);
}

}  // namespace

TEST(Readme, PluginOfOnesOwnBuildsAgainstAnInstallationAndAppearsByName) {
  const std::string readme = readFile(fs::path(PECTORA_SOURCE) / "README.md");
  const std::string code = codeBlock(readme, "cpp"), list = codeBlock(readme, "cmake");
  EXPECT_LE(std::count(code.begin(), code.end(), '\n'), 27);
  const fs::path folder = freshFolder("readme");
  fs::create_directories(folder / "source");
  std::ofstream(folder / "source/tether.cpp") << code;
  std::ofstream(folder / "source/CMakeLists.txt") << list;

  // Install, then build the plugin as its author would.
  const std::string prefix = (folder / "prefix").string(), build = (folder / "build").string(), log = " >" + (folder / "log.txt").string() + " 2>&1";
  ASSERT_EQ(exitCode("cmake --install " PECTORA_BUILD " --prefix " + prefix + log), 0) << readFile(folder / "log.txt");
  ASSERT_EQ(exitCode("cmake -G Ninja -S " + (folder / "source").string() + " -B " + build + " -DCMAKE_CXX_FLAGS='" PECTORA_SANITIZE_FLAGS "' -DCMAKE_PREFIX_PATH=" + prefix + log), 0)
      << readFile(folder / "log.txt");
  ASSERT_EQ(exitCode("cmake --build " + build + log), 0) << readFile(folder / "log.txt");

  // The installed program finds it by name.
  const std::string pectora = "PECTORA_PLUGIN_PATH=" + build + " " + prefix + "/bin/pectora ";
  const fs::path out = folder / "out.txt";
  ASSERT_EQ(exitCode(pectora + "list > " + out.string()), 0);
  EXPECT_NE(readFile(out).find("effect.tether"), std::string::npos);
  EXPECT_NE(readFile(out).find("solver.verlet"), std::string::npos);
  EXPECT_EQ(readFile(out).find("cannot be used"), std::string::npos) << readFile(out);
  std::ofstream(folder / "use.lua") << "local t = effect.tether{ stiffness = 0.2 } print(t.kind)";
  ASSERT_EQ(exitCode(pectora + "run --quiet " + (folder / "use.lua").string() + " > " + out.string()), 0);
  EXPECT_EQ(readFile(out), "Effect\n");
  EXPECT_EQ(exitCode(pectora + "run correction --help > " + out.string()), 0) << "the scripts are installed, too";
}
