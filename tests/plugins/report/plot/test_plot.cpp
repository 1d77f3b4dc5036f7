#include "plugins/report/common/gnuplot.h"
#include "plugins/report/plot/plot.h"

#include "kernel/stage/error.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

using namespace pectora;
namespace fs = std::filesystem;

namespace {

WorkPrecision picture() {
  return {"A 'quoted' title", "time, s", "error, mm",
          {{"newton", 0.3, 1e-3}, {"newton", 0.1, 1e-1}, {"verlet", 0.05, 0.2}, {"verlet", 0.5, 0.05}, {"verlet", 0.2, 0}},
          true, 0.6, "scanner"};
}

}  // namespace

TEST(Plot, FrontIsWhatNoOtherRunBeatsInBoth) {
  const std::vector<WorkPoint> front = paretoFront(picture().points);
  ASSERT_EQ(front.size(), 3u);
  EXPECT_EQ(front[0].series, "verlet");
  EXPECT_EQ(front[1].error, 1e-1);
  EXPECT_EQ(front[2].error, 1e-3);   // the slower verlet is beaten by this one
}

TEST(Plot, GnuplotDrawsAPng) {
  const fs::path png = fs::path(testing::TempDir()) / "pectora_plot_test.png";
  fs::remove(png);
  drawPicture(png.string(), [](const std::string& file) { return gnuplotCommands(picture(), file); });
  std::ifstream file(png, std::ios::binary);
  std::string head(8, '\0');
  file.read(head.data(), 8);
  EXPECT_EQ(head, "\x89PNG\r\n\x1a\n");
  EXPECT_GT(fs::file_size(png), 5000u);
  EXPECT_FALSE(fs::exists(png.string() + ".gp"));
  fs::remove(png);
}

TEST(Plot, RefusesAPictureWithoutARun) {
  WorkPrecision empty = picture();
  empty.points = {{"all", 0, 1}, {"all", 1, -1}};
  EXPECT_THROW(gnuplotCommands(empty, "x.png"), Error);
}
