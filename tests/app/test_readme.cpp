// What the README shows must work: its plugin is built as it stands, outside of the tree, and used by name.
#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace fs = std::filesystem;

namespace {

std::string readFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// The first code block of a language.
std::string codeBlock(const std::string& text, const std::string& language) {
  const std::string fence = "```" + language + "\n";
  const std::size_t begin = text.find(fence) + fence.size();
  return text.substr(begin, text.find("```", begin) - begin);
}

int exitCode(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST(Readme, PluginOfOnesOwnIsAsShortAsPromisedAndAppearsByName) {
  const std::string code = codeBlock(readFile(fs::path(PECTORA_SOURCE) / "README.md"), "cpp");
  EXPECT_LE(std::count(code.begin(), code.end(), '\n'), 27);
  const fs::path folder = fs::path(testing::TempDir()) / ("pectora_readme_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "tether.cpp") << code;
  const fs::path library = fs::path(PECTORA_PLUGINS).parent_path();
  ASSERT_EQ(exitCode("c++ -std=c++20 -O1 -shared -fPIC " PECTORA_SANITIZE_FLAGS " -I" PECTORA_SOURCE " " + (folder / "tether.cpp").string() + " -o " +
                     (folder / "effect.tether.so").string() + " -L" + library.string() + " -lpectora"), 0);
  const std::string environment = "PECTORA_PLUGIN_PATH=" + folder.string() + " ";
  const fs::path out = folder / "out.txt";
  ASSERT_EQ(exitCode(environment + PECTORA_PROGRAM " list > " + out.string()), 0);
  EXPECT_NE(readFile(out).find("effect.tether"), std::string::npos);
  EXPECT_EQ(readFile(out).find("cannot be used"), std::string::npos) << readFile(out);
  std::ofstream(folder / "use.lua") << "local t = effect.tether{ stiffness = 0.2 } print(t.kind)";
  ASSERT_EQ(exitCode(environment + PECTORA_PROGRAM " run --quiet " + (folder / "use.lua").string() + " > " + out.string()), 0);
  EXPECT_EQ(readFile(out), "Effect\n");
}
