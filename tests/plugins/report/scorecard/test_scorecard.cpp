#include "plugins/report/scorecard/scorecard.h"

#include "kernel/stage/error.h"
#include "plugins/report/common/gnuplot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

using namespace pectora;
namespace fs = std::filesystem;

namespace {

const std::vector<std::string> kLines{"phantom,ribs,rib_rms,note", "cup_4,20,0.5,x", "it's_5mm,18,2.25,"};

}  // namespace

TEST(Scorecard, ReadsNamesValuesAndGoals) {
  const Scorecard card = readScorecard("A title", kLines, {-20, 1});
  ASSERT_EQ(card.rows.size(), 2u);
  EXPECT_EQ(card.columns, (std::vector<std::string>{"ribs", "rib_rms", "note"}));
  EXPECT_EQ(card.values[1][1], 2.25);
  EXPECT_TRUE(std::isnan(card.values[0][2]));
  EXPECT_TRUE(card.isLeast[0]);
  EXPECT_EQ(card.goals[2], 0);
  EXPECT_THROW(readScorecard("", {"a,b", "1"}, {}), Error);
  EXPECT_THROW(readScorecard("", {"a,b"}, {}), Error);
}

TEST(Scorecard, KnowsWhatReachesAGoal) {
  EXPECT_LE(miss(-0.9, 1, false), 1);
  EXPECT_GT(miss(-1.1, 1, false), 1);
  EXPECT_LE(miss(20, 20, true), 1);
  EXPECT_GT(miss(19, 20, true), 1);
  EXPECT_TRUE(std::isnan(miss(3, 0, false)));
}

TEST(Scorecard, IsDrawnByGnuplot) {
  const fs::path png = fs::path(testing::TempDir()) / "pectora_scorecard_test.png";
  fs::remove(png);
  drawPicture(png.string(), [](const std::string& file) { return gnuplotCommands(readScorecard("A title", kLines, {-20, 1}), file); });
  std::ifstream file(png, std::ios::binary);
  std::string head(8, '\0');
  file.read(head.data(), 8);
  EXPECT_EQ(head, "\x89PNG\r\n\x1a\n");
  EXPECT_GT(fs::file_size(png), 5000u);
  fs::remove(png);
}
