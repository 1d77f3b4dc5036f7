// A scan beside the prediction: how a user comes from its file to distances.
#include "tests/app/view/desk.h"

using namespace pectora;
using namespace pectora::view;

TEST(Compare, ShowsAScanForItsLandmarksAndTakesThemFromAFile) {
  Desktop desk("view_compare_home");
  // A phantom's scan and landmarks as files; the window has the CT alone.
  const std::string command = "cd " + desk.home + " && " PECTORA_PROGRAM " run --quiet " PECTORA_SOURCE "/scripts/phantom.lua matrix=128 slice_spacing=5 out=patient > out.txt 2>&1";
  ASSERT_EQ(exitCode(command), 0) << readFile(desk.home + "/out.txt");
  const std::string folder = desk.home + "/patient/", truth = folder + "truth/";
  desk.rest();
  makeCoarse(desk.context().choices);
  desk.context().open(folder + "dicom");
  desk.rest();
  ASSERT_TRUE(desk.results().motionValue()) << desk.results().error;
  desk.click("tab.compare");
  EXPECT_FALSE(desk.hand.sees("scene")) << "there is nothing to compare yet, and it is said what to do";
  EXPECT_FALSE(desk.hand.sees("landmarks.scan"));

  // The scan lies beside the skin at once; from the file its landmarks come, and then its distances.
  desk.context().open(truth + "scan.ply");
  desk.rest();
  EXPECT_TRUE(desk.hand.sees("landmarks.ct"));
  EXPECT_TRUE(desk.hand.sees("landmarks.scan"));
  desk.context().open(truth + "landmarks.csv");
  desk.rest();
  EXPECT_EQ(desk.context().choices.scanLandmarks.points.size(), 4u) << desk.told();
  ASSERT_TRUE(desk.results().comparisonValue()) << desk.results().error;
  EXPECT_TRUE(desk.hand.sees("scene")) << "the distances, without being asked for";
  EXPECT_FALSE(desk.hand.sees("landmarks.scan"));

  // One step, which is undone as such; then nothing brings the scan here, and nothing is put before the user again.
  desk.click("undo");
  EXPECT_TRUE(desk.context().choices.scanLandmarks.points.empty());
  EXPECT_FALSE(desk.results().comparisonValue());

  // By hand: until all four stand on both, the scan stays where it is under the mouse.
  desk.click("landmarks.place");
  const auto picture = [&] {
    ImGui::GetIO().MousePos = {-1, -1};
    desk.rest();
    return desk.target->pixels();
  };
  const ImVec2 low = desk.hand.place("landmarks.scan", 0, 0), high = desk.hand.place("landmarks.scan", 1, 1);
  const ImVec4 whole{low.x, low.y, high.x - low.x, high.y - low.y};
  const auto upright = picture();
  // On the scan a tenth lower: registered, it would go up by that.
  const ImVec2 places[] = {{0.5f, 0.38f}, {0.5f, 0.58f}, {0.35f, 0.47f}};
  for (ImVec2 at : places) desk.click("landmarks.ct", at.x, at.y), desk.click("landmarks.scan", at.x, at.y + 0.1f);
  ASSERT_TRUE(desk.results().byLandmarks.value) << "three are enough to register by";
  const double names = meanDifference(upright, picture(), 1280, whole);
  EXPECT_LT(names, 4) << "but for three names: boxes of 100 x 20 of its 320 x 700 pixels, by 100 grey levels";
  desk.click("landmarks.ct", 0.65f, 0.47f), desk.click("landmarks.scan", 0.65f, 0.57f);
  EXPECT_GT(meanDifference(upright, picture(), 1280, whole), 2 * names) << "all four put it where it belongs";
  EXPECT_EQ(openGlErrors(), 0);

  // Another patient has another scan.
  std::filesystem::copy(folder + "dicom", desk.home + "/other", std::filesystem::copy_options::recursive);
  desk.context().open(desk.home + "/other");
  desk.rest();
  EXPECT_FALSE(desk.context().choices.hasScan());
  EXPECT_FALSE(desk.results().scan.value);
  desk.context().open(truth + "scan.ply.csv");
  EXPECT_NE(desk.context().message.find("There is nothing at"), std::string::npos);
}
