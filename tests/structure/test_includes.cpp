// The arrows of the architecture: value <- physics <- stage <- host <- script <- app; a plugin sees no other plugin.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

namespace fs = std::filesystem;

namespace {

struct Include {
  std::string file, target;
};

std::vector<Include> includesBelow(const std::string& folder) {
  static const std::regex line(R"re(^\s*#include\s*[<"]([^>"]+)[>"])re");
  std::vector<Include> found;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(PECTORA_SOURCE) / folder)) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".h" && ending != ".cpp") continue;
    std::ifstream file(entry.path());
    std::smatch match;
    for (std::string text; std::getline(file, text);)
      if (std::regex_search(text, match, line)) found.push_back({fs::relative(entry.path(), PECTORA_SOURCE).string(), match[1]});
  }
  return found;
}

void expectNone(const std::string& folder, const std::regex& forbidden, const std::string& rule) {
  const std::vector<Include> all = includesBelow(folder);
  ASSERT_FALSE(all.empty()) << folder;
  for (const Include& include : all)
    EXPECT_FALSE(std::regex_search(include.target, forbidden)) << include.file << " includes " << include.target << ": " << rule;
}

}  // namespace

TEST(Includes, PointOneWayThroughTheKernel) {
  expectNone("kernel/value", std::regex("^kernel/(physics|stage|host|script)/|^(Eigen|tbb|lua|fmt)"), "values stand on std alone");
  expectNone("kernel/physics", std::regex("^kernel/(stage|host|script)/"), "physics sees values only");
  expectNone("kernel/stage", std::regex("^kernel/(host|script)/"), "stage sees values and physics");
  expectNone("kernel/host", std::regex("^kernel/script/"), "the host knows no scripts");
  expectNone("kernel", std::regex("^(plugins|app)/"), "the kernel knows no plugin and no program");
}

TEST(Includes, OfAPluginStayInItsFolderAndTheInterface) {
  for (const Include& include : includesBelow("plugins")) {
    EXPECT_FALSE(std::regex_search(include.target, std::regex("^kernel/(host|script)/|^app/"))) << include.file << " includes " << include.target;
    if (!include.target.starts_with("plugins/")) continue;
    // plugins/STAGE/NAME/...: the same plugin, what a stage's plugins share, or what several stages share.
    const auto parts = [](const std::string& path) {
      const fs::path whole = path;
      auto part = whole.begin();
      const std::string stage = (++part)->string(), name = (++part)->string();
      return std::pair{stage, name};
    };
    const auto [stage, name] = parts(include.file);
    const auto [targetStage, targetName] = parts(include.target);
    const bool isWriter = include.file.starts_with("plugins/report/dicom/") && include.target == "plugins/loader/dicom/series_writer.h";
    EXPECT_TRUE((targetStage == stage && (targetName == name || targetName == "common")) || targetStage == "common" || isWriter) << include.file << " includes " << include.target;
  }
}

TEST(Includes, OfLibrariesStayInTheirRooms) {
  const auto only = [](const std::string& library, const std::string& room) {
    for (const char* folder : {"kernel", "plugins", "app"})
      for (const Include& include : includesBelow(folder)) {
        if (!std::regex_search(include.target, std::regex(library))) continue;
        EXPECT_TRUE(include.file.starts_with(room)) << include.file << " includes " << include.target;
      }
  };
  only("^gdcm", "plugins/loader/dicom/");
  only("^(lua|lauxlib|lualib)", "kernel/script/");
  only("^(imgui|GLFW|GL/|epoxy)", "app/view/");
}
