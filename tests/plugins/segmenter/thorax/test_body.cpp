#include "solids.h"

#include "kernel/stage/error.h"
#include "plugins/segmenter/thorax/skin.h"

#include <gtest/gtest.h>

using namespace pectora;
using namespace pectora::thorax;

namespace {

/// A trunk of 240 x 160 mm with two lungs, on a couch 5 mm behind, 60 mm long.
std::shared_ptr<Volume> trunk() {
  auto ct = solids::air({160, 130, 30}, {2, 2, 2});
  solids::fill(*ct, 40, solids::cylinder(160, 120, 120, 80));
  solids::fill(*ct, -870, solids::cylinder(105, 120, 35, 50));
  solids::fill(*ct, -870, solids::cylinder(215, 120, 35, 50));
  solids::fill(*ct, -100, [](Vec3 p) { return std::abs(p.y - 208) - 2; });
  return ct;
}

TEST(FindBody, TakesTrunkAndLungsAndLeavesTheCouch) {
  const auto ct = trunk();
  const Body body = findBody(*ct);
  const auto at = [&](double x, double y) { return body.nearest({x, y, 30}); };
  const auto isTorso = [&](double x, double y) { const auto p = at(x, y); return body.isTorso(p[0], p[1], p[2]); };
  const auto isLung = [&](double x, double y) { const auto p = at(x, y); return body.isLung(p[0], p[1], p[2]); };
  EXPECT_TRUE(isTorso(160, 120));
  EXPECT_TRUE(isTorso(105, 120));  // a lung belongs to the torso
  EXPECT_TRUE(isLung(105, 120));
  EXPECT_FALSE(isLung(160, 120));
  EXPECT_FALSE(isTorso(160, 208));
  EXPECT_FALSE(isTorso(20, 20));
  EXPECT_TRUE(body.hasLungs);
}

TEST(FindBody, OfAirIsAnErrorThatSaysWhatToDo) {
  const auto ct = solids::air({64, 64, 20}, {2, 2, 2});
  try {
    findBody(*ct);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("no body"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("check"), std::string::npos);
  }
}

TEST(FindBody, OfSolidBoneOrATinyCtIsAnError) {
  auto solid = solids::air({64, 64, 20}, {2, 2, 2});
  std::fill(solid->hu.begin(), solid->hu.end(), std::int16_t(800));
  EXPECT_THROW(findBody(*solid), Error);
  EXPECT_THROW(findBody(*solids::air({4, 4, 2}, {1, 1, 1})), Error);
}

TEST(FindSkin, LiesOnAnEllipseToAFewHundredthsOfAMillimetre) {
  auto ct = solids::air({200, 160, 16}, {0.8, 0.8, 3});
  const auto ellipse = solids::cylinder(80, 64, 66, 44);
  solids::fill(*ct, 20, ellipse);
  const Body body = findBody(*ct);
  const SkinSlice skin = findSkin(*ct, body, 8, 70, SkinSettings{});
  ASSERT_GT(skin.front.size(), 100u);
  for (const Point2& p : skin.front) EXPECT_NEAR(ellipse({p.x, p.y, 0}), 0, 0.08);
  EXPECT_FALSE(skin.clipped);
  // From the right over the front to the left, both ends on the coronal plane.
  EXPECT_DOUBLE_EQ(skin.front.front().y, 70);
  EXPECT_DOUBLE_EQ(skin.front.back().y, 70);
  EXPECT_LT(skin.front.front().x, 20);
  EXPECT_GT(skin.front.back().x, 140);
  for (std::size_t n = 1; n + 1 < skin.front.size(); ++n) EXPECT_LT(skin.front[n].y, 70 + 1e-9);
}

TEST(FindSkin, ThePapersEdgeLiesTwoToFourMillimetresOutside) {
  // Science notes, section 7: sigma sqrt(2 ln(1 / t)) outside, 1.8 mm for t = 0.5 to 3.9 mm for t = 0.1 at 2.5 px.
  auto ct = solids::air({200, 160, 16}, {0.684, 0.684, 3});
  const auto ellipse = solids::cylinder(68, 55, 55, 40);
  solids::fill(*ct, 20, ellipse);
  const Body body = findBody(*ct);
  SkinSettings settings;
  settings.edge = Edge::paper;
  const SkinSlice skin = findSkin(*ct, body, 8, 60, settings);
  ASSERT_GT(skin.front.size(), 100u);
  double mean = 0;
  for (const Point2& p : skin.front) mean += ellipse({p.x, p.y, 0}) / double(skin.front.size());
  EXPECT_NEAR(mean, 2.5 * 0.684 * std::sqrt(2 * std::log(4)), 0.6);  // t = 0.25; whole pixels
}

TEST(FindSkin, SaysWhereItLeavesTheFieldOfView) {
  auto ct = solids::air({100, 100, 16}, {2, 2, 3});
  solids::fill(*ct, 20, solids::cylinder(100, 100, 120, 60));
  EXPECT_TRUE(findSkin(*ct, findBody(*ct), 8, 110, SkinSettings{}).clipped);
}

TEST(FrontOf, AnOutlineThatTheCoronalPlaneMissesIsEmpty) {
  EXPECT_TRUE(frontOf({{0, 0}, {1, 0}, {1, 1}}, 5).empty());
  EXPECT_TRUE(frontOf({}, 5).empty());
}

}  // namespace
