// Corrections as a script makes them, and what the summary keeps of them.
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace fs = std::filesystem;

namespace {

std::string textOf(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

// Runs a script in an empty folder; returns what the program printed.
std::string logOf(const fs::path& folder, const std::string& script) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  std::ofstream(folder / "script.lua") << script;
  const std::string command = std::string(PECTORA_PROGRAM) + " run " + (folder / "script.lua").string() + " > " + (folder / "log.txt").string() + " 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << textOf(folder / "log.txt");
  return textOf(folder / "log.txt");
}

}  // namespace

TEST(Corrections, FromAScriptChangeTheAnatomyAndStandInTheProvenance) {
  const fs::path folder = pectora::scratch("correct");
  const std::string log = logOf(folder, R"(
    local ct = loader.phantom{ matrix = 128, slice_spacing = 5, coverage = "thorax" }
    local anatomy = segmenter.thorax(ct, { bone_regions = { -200, -200, -330, 200, 200, -320, 150 } })
    local before = anatomy.ribs_left
    anatomy = correct.rib(anatomy, { side = "left", number = 12 })
    anatomy = correct.joint(anatomy, { joint = "notch", side = "right", number = 3, at = { -19, -75, -110 } })
    print(before - anatomy.ribs_left)
    local ok, message = pcall(correct.rib, anatomy, { side = "left", number = 12 })
    print(ok, tostring(message))
    report.files{ anatomy = anatomy, cage = splines.cartilage(anatomy, ct), path = ")" + (folder / "out").string() + R"(" })");
  const std::string summary = textOf(folder / "out/summary.json");
  EXPECT_NE(log.find("1.0\n"), std::string::npos) << log;
  EXPECT_NE(log.find("there is no such rib"), std::string::npos) << log;
  EXPECT_NE(log.find("; left 1, "), std::string::npos) << log;
  for (const char* kept : {"correct.rib", "correct.joint", "\"notch\"", "bone_regions"}) EXPECT_NE(summary.find(kept), std::string::npos) << kept;
  fs::remove_all(folder);
}

TEST(Corrections, AThresholdOfItsOwnInABoxDecidesWhatIsBoneThere) {
  const fs::path folder = pectora::scratch("bone_regions");
  // Nothing to the patient's left is as dense as 3000 HU.
  const std::string log = logOf(folder, R"(
    local ct = loader.phantom{ matrix = 128, slice_spacing = 5, coverage = "thorax" }
    local usual = segmenter.thorax(ct, {})
    local denser = segmenter.thorax(ct, { bone_regions = { 30, -400, -2000, 400, 400, 2000, 3000 } })
    print("right", usual.ribs_right == denser.ribs_right)
    print("left", usual.ribs_left - denser.ribs_left >= 6))");
  EXPECT_NE(log.find("right\ttrue"), std::string::npos) << log;
  EXPECT_NE(log.find("left\ttrue"), std::string::npos) << log;
  fs::remove_all(folder);
}
