#include "plugins/correct/common/corrections.h"

#include "kernel/stage/error.h"

#include <gtest/gtest.h>

using namespace pectora;

namespace {

// Ribs 4 and 5 on both sides, a third one without a number on the left; a square sternum, flat layers.
Anatomy simple() {
  Anatomy a;
  for (int n : {4, 5, 0})
    for (Side side : {Side::right, Side::left}) {
      if (n == 0 && side == Side::right) continue;
      Rib rib{side, n, {}, true, false};
      for (int i = 0; i <= 50; ++i) rib.centerline.push_back({(side == Side::right ? -1 : 1) * (20 + 2.0 * i), 0, n == 0 ? -200.0 : -20.0 * n});
      a.ribs.push_back(rib);
    }
  for (int z = -150; z <= -40; z += 5) {
    const double h = z;
    a.sternum.contours.push_back({{-15, -80, h}, {15, -80, h}, {15, -70, h}, {-15, -70, h}});
    a.sternum.axis.push_back({0, -75, h});
    a.skin.push_back({h, {{-150, -90, h}, {0, -90, h}, {150, -90, h}}, z < -140});
    a.pleura.push_back({h, {{-120, -65, h}, {0, -65, h}, {120, -65, h}}, false});
    a.vertebralFront.push_back({0, 0, h});
    LevelMetrics m;
    m.z = h, m.transverse = 240, m.sternumToVertebra = 70, m.deepestInnerWall = 80;
    a.metrics.push_back(m);
    a.contours.push_back({int(z), "sternum", 0, Side::right, a.sternum.contours.back(), true});
  }
  a.sternum.notches = {{Side::left, 4, {15, -75, -90}}};
  return a;
}

std::string errorOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST(DropRib, TakesOutTheRibThatIsNamed) {
  const Anatomy changed = dropRib(simple(), {Side::left, 5, {}});
  EXPECT_EQ(changed.ribs.size(), 4u);
  EXPECT_EQ(changed.rib(Side::left, 5), nullptr);
  EXPECT_NE(changed.rib(Side::right, 5), nullptr);
}

TEST(DropRib, TakesItsOutlinesOutOfTheSlicesAndNoOthers) {
  Anatomy anatomy = simple();
  const std::size_t others = anatomy.contours.size() + 2;
  for (const auto& [side, number] : {std::pair{Side::left, 5}, {Side::right, 5}, {Side::left, 0}}) anatomy.contours.push_back({0, "rib", number, side, {{0, 0, 0}}, true});
  const Anatomy changed = dropRib(anatomy, {Side::left, 5, {}});
  EXPECT_EQ(changed.contours.size(), others);
  for (const SliceContour& c : changed.contours) EXPECT_FALSE(c.structure == "rib" && c.side == Side::left && c.number == 5);
}

TEST(DropRib, FindsARibWithoutANumberByAPointNearToIt) {
  const Anatomy changed = dropRib(simple(), {Side::left, 0, Vec3{60, 3, -195}});
  EXPECT_EQ(changed.ribs.size(), 4u);
  EXPECT_NE(changed.rib(Side::left, 5), nullptr);
}

TEST(DropRib, NamesTheRibsThatThereAreWhenOneIsNamedThatIsNot) {
  const std::string error = errorOf([] { dropRib(simple(), {Side::left, 9, {}}); });
  EXPECT_NE(error.find("left 9"), std::string::npos) << error;
  EXPECT_NE(error.find("right 4, 5; left 4, 5 and 1 without a number"), std::string::npos) << error;
}

TEST(RenumberRib, GivesTheNumberAndKeepsTheOrder) {
  const Anatomy changed = renumberRib(simple(), {Side::left, 0, Vec3{60, 0, -200}}, 3);
  ASSERT_NE(changed.rib(Side::left, 3), nullptr);
  EXPECT_EQ(changed.ribs.front().number, 3);
  EXPECT_EQ(changed.rib(Side::left, 3)->centerline.front().z, -200);
}

TEST(RenumberRib, RefusesANumberThatIsTakenOrNone) {
  EXPECT_NE(errorOf([] { renumberRib(simple(), {Side::left, 4, {}}, 5); }).find("taken"), std::string::npos);
  EXPECT_NE(errorOf([] { renumberRib(simple(), {Side::left, 4, {}}, 13); }).find("1 to 12"), std::string::npos);
}

TEST(MoveJunction, CutsTheRibOrCarriesItOnToThePoint) {
  const Anatomy cut = moveJunction(simple(), {Side::left, 4, {}}, {80, 1, -80});
  EXPECT_EQ(cut.rib(Side::left, 4)->centerline.back(), (Vec3{80, 1, -80}));
  EXPECT_TRUE(cut.rib(Side::left, 4)->reachesJunction);
  for (const Vec3& p : cut.rib(Side::left, 4)->centerline) EXPECT_LE(p.x, 80);
  const Anatomy longer = moveJunction(simple(), {Side::left, 4, {}}, {140, -6, -90});
  EXPECT_EQ(longer.rib(Side::left, 4)->centerline.back(), (Vec3{140, -6, -90}));
  EXPECT_GT(longer.rib(Side::left, 4)->centerline.size(), 60u);
}

TEST(MoveJunction, RefusesAPointFarFromTheRib) {
  EXPECT_NE(errorOf([] { moveJunction(simple(), {Side::left, 4, {}}, {-140, 0, -80}); }).find("right side"), std::string::npos);
}

TEST(MoveNotch, IsKeptAsGiven) {
  const Anatomy moved = moveNotch(simple(), Side::left, 4, {17, -76, -92});
  ASSERT_EQ(moved.sternum.notches.size(), 1u);
  EXPECT_EQ(moved.sternum.notches[0].position, (Vec3{17, -76, -92}));
  EXPECT_TRUE(moved.sternum.notches[0].isGiven);
  EXPECT_EQ(moveNotch(simple(), Side::right, 3, {-17, -76, -60}).sternum.notches.size(), 2u);
  EXPECT_NE(errorOf([] { moveNotch(simple(), Side::left, 8, {}); }).find("1 to 7"), std::string::npos);
}

TEST(GiveContour, MeasuresTheLevelAgainFromTheSternum) {
  const Anatomy changed = giveContour(simple(), "sternum", -101, {{-15, -60, 0}, {15, -60, 0}, {15, -52, 0}, {-15, -52, 0}});
  for (const LevelMetrics& m : changed.metrics) EXPECT_NEAR(m.sternumToVertebra, m.z == -100 ? 52 : 70, 1e-9) << m.z;
  for (const SliceContour& c : changed.contours)
    if (c.points.front().z == -100) {
      EXPECT_EQ(c.points.front().y, -60);
    }
}

TEST(GiveContour, MeasuresTheLevelAgainFromThePleuraAndUnclipsTheSkin) {
  const Anatomy wider = giveContour(simple(), "pleura", -100, {{-130, -10, 0}, {0, -75, 0}, {130, -10, 0}});
  for (const LevelMetrics& m : wider.metrics) EXPECT_NEAR(m.transverse, m.z == -100 ? 260 : 240, 1e-9);
  const Anatomy skin = giveContour(simple(), "skin", -145, {{-140, 0, 0}, {0, -88, 0}, {140, 0, 0}});
  EXPECT_TRUE(skin.skin[0].clipped);
  EXPECT_FALSE(skin.skin[1].clipped);
  EXPECT_EQ(skin.skin[1].points[1].y, -88);
}

TEST(GiveContour, RefusesWhatItCannotPlace) {
  EXPECT_NE(errorOf([] { giveContour(simple(), "liver", -100, {{}, {}, {}}); }).find("skin, pleura, sternum"), std::string::npos);
  EXPECT_NE(errorOf([] { giveContour(simple(), "skin", -100, {{}, {}}); }).find("three points"), std::string::npos);
  EXPECT_NE(errorOf([] { giveContour(simple(), "skin", 300, {{}, {}, {}}); }).find("-40.0 mm"), std::string::npos);
}
