// Real CTs have no truth; what is found must at least be consistent with itself and with anatomy.
#include "kernel/host/runner.h"
#include "kernel/value/anatomy.h"
#include "kernel/value/curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

using namespace pectora;

namespace {

struct Quiet final : Messages {};

/// The anatomy of a CT of the collection, segmented once; null where the collection is absent.
std::shared_ptr<const Anatomy> anatomyOf(const std::string& name) {
  static std::map<std::string, std::shared_ptr<const Anatomy>> made;
  const std::string folder = std::string(PECTORA_DATA) + "/ct/" + name + "/dicom";
  if (!std::filesystem::exists(folder)) return nullptr;
  if (!made.contains(name)) {
    static Registry registry({PECTORA_PLUGINS});
    static Quiet messages;
    static std::atomic<bool> cancel{false};
    Runner runner(registry, messages, cancel);
    const auto ct = runner.run("loader.dicom", {{"path", folder}}, {});
    made[name] = std::dynamic_pointer_cast<const Anatomy>(runner.run("segmenter.thorax", {}, {ct}).front().value);
  }
  return made[name];
}

class RealCt : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    anatomy = anatomyOf(GetParam());
    if (!anatomy) GTEST_SKIP() << "PECTORA_DATA has no folder ct/" << GetParam();
  }
  std::shared_ptr<const Anatomy> anatomy;
};

int ribsOn(const Anatomy& a, Side side) {
  return int(std::count_if(a.ribs.begin(), a.ribs.end(), [&](const Rib& r) { return r.side == side; }));
}

/// Whether two segments of a line cross each other, seen along z.
bool crossesItself(const std::vector<Vec3>& line) {
  const auto turn = [](Vec3 a, Vec3 b, Vec3 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); };
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    for (std::size_t j = i + 2; j + 1 < line.size(); ++j)
      if (turn(line[i], line[i + 1], line[j]) * turn(line[i], line[i + 1], line[j + 1]) < 0 &&
          turn(line[j], line[j + 1], line[i]) * turn(line[j], line[j + 1], line[i + 1]) < 0)
        return true;
  return false;
}

TEST_P(RealCt, HasAsManyRibsOnTheRightAsOnTheLeft) {
  EXPECT_EQ(ribsOn(*anatomy, Side::right), ribsOn(*anatomy, Side::left));
  EXPECT_GE(ribsOn(*anatomy, Side::right), 5);
}

TEST_P(RealCt, HasRibsThatLieBelowEachOtherAndAreAsLongAsRibs) {
  for (Side side : {Side::right, Side::left}) {
    const Rib* above = nullptr;
    for (const Rib& rib : anatomy->ribs) {
      if (rib.side != side) continue;
      EXPECT_LT(polylineLength(rib.centerline), 420) << rib.number;   // the longest rib of an adult is about 330 mm
      if (rib.number == 0) continue;
      // By their backs; those that the CT's upper border cuts, by their fronts.
      if (above && rib.reachesVertebra && above->reachesVertebra) {
        EXPECT_LT(rib.centerline.front().z, above->centerline.front().z) << sideName(side) << rib.number;
      } else if (above) {
        EXPECT_LT(rib.centerline.back().z, above->centerline.back().z) << sideName(side) << rib.number;
      }
      above = &rib;
    }
  }
}

TEST_P(RealCt, HasNoJunctionWhereTheCtsBorderCutsARib) {
  const double lowest = anatomy->skin.front().z;
  for (const Rib& rib : anatomy->ribs)
    if (rib.centerline.back().z < lowest + 4) {
      EXPECT_FALSE(rib.reachesJunction) << sideName(rib.side) << rib.number;
    }
}

TEST_P(RealCt, HasLayersThatRiseLevelByLevelAndDoNotCrossThemselves) {
  ASSERT_EQ(anatomy->skin.size(), anatomy->pleura.size());
  for (std::size_t n = 0; n < anatomy->skin.size(); ++n) {
    if (n > 0) {
      EXPECT_GT(anatomy->skin[n].z, anatomy->skin[n - 1].z);
    }
    EXPECT_EQ(anatomy->skin[n].z, anatomy->pleura[n].z);
    EXPECT_FALSE(crossesItself(anatomy->pleura[n].points)) << "pleura at " << anatomy->skin[n].z;
    if (n % 10 == 0 && !anatomy->skin[n].clipped) {
      EXPECT_FALSE(crossesItself(anatomy->skin[n].points)) << "skin at " << anatomy->skin[n].z;
    }
  }
}

TEST_P(RealCt, HasAWallAsThickAsChestWallsAre) {
  // From the pleura to the nearest skin of its level, where there are ribs: at least the setting's 4 mm; in front, where there is
  // no arm and no flank, at most 90 mm, a large breast.
  double lowest = 1e300;
  for (const Rib& rib : anatomy->ribs)
    for (const Vec3& p : rib.centerline) lowest = std::min(lowest, p.z);
  for (std::size_t n = 0; n < anatomy->skin.size(); n += 5) {
    if (anatomy->skin[n].clipped || anatomy->skin[n].z < lowest) continue;
    const std::vector<Vec3>& inner = anatomy->pleura[n].points;
    for (std::size_t i = 0; i < inner.size(); i += 5) {
      double nearest = 1e300;
      for (const Vec3& q : anatomy->skin[n].points) nearest = std::min(nearest, distance(q, inner[i]));
      EXPECT_GT(nearest, 3.5) << anatomy->skin[n].z;
      const bool isInFront = 4 * i > inner.size() && 4 * i < 3 * inner.size();
      EXPECT_LT(isInFront ? nearest : 0, 90) << anatomy->skin[n].z;
    }
  }
}

TEST_P(RealCt, HasAnInnerWallThatDoesNotPassThroughTheSternum) {
  // Where the sternum was outlined, in the middle half of its width.
  for (const std::vector<Vec3>& contour : anatomy->sternum.contours)
    for (const LayerSlice& pleura : anatomy->pleura) {
      if (contour.empty() || std::abs(pleura.z - contour.front().z) > 0.01) continue;
      const auto [right, left] = std::minmax_element(contour.begin(), contour.end(), [](Vec3 a, Vec3 b) { return a.x < b.x; });
      const double middle = 0.5 * (right->x + left->x), half = 0.25 * (left->x - right->x);
      for (const Vec3& p : pleura.points)
        EXPECT_FALSE(std::abs(p.x - middle) < half && isInContour(contour, p)) << "at z " << p.z;
    }
}

TEST_P(RealCt, TakesNeitherCouchNorBlanketForBone) {
  double back = -1e300;
  for (const SliceContour& c : anatomy->contours)
    if (c.structure == "vertebra")
      for (const Vec3& p : c.points) back = std::max(back, p.y);
  for (const SliceContour& c : anatomy->contours)
    if (c.structure == "scapula" || c.structure == "rib") {
      for (const Vec3& p : c.points) ASSERT_LT(p.y, back + 60) << c.structure << " in slice " << c.slice;
    }
}
INSTANTIATE_TEST_SUITE_P(Ct, RealCt, testing::Values("lidc_0314", "acrin_flt_013", "cptac_c3l00189"), [](const auto& each) { return std::string(each.param); });

TEST(RealCts, OfAWholeThoraxHasAllTwelvePairsAndSaysWhereTheSkinIsClipped) {
  const auto anatomy = anatomyOf("lidc_0314");
  if (!anatomy) GTEST_SKIP() << "PECTORA_DATA has no folder ct/lidc_0314";
  for (Side side : {Side::right, Side::left})
    for (int number = 1; number <= 12; ++number) EXPECT_NE(anatomy->rib(side, number), nullptr) << sideName(side) << number;
  // The whole skin is in view in the lowest 191 slices of 1 mm.
  ASSERT_EQ(std::count_if(anatomy->ranges.begin(), anatomy->ranges.end(), [](const SliceRange& r) { return r.what == "clipped skin"; }), 1);
  const double lowest = anatomy->skin.front().z;
  for (const SliceRange& range : anatomy->ranges)
    if (range.what == "clipped skin") {
      EXPECT_NEAR(range.low - lowest, 191, 3);
    }
}

TEST(RealCts, OfAWholeThoraxHasItsManubriumUpToTheNotchBetweenTheClavicles) {
  const auto anatomy = anatomyOf("lidc_0314");
  if (!anatomy) GTEST_SKIP() << "PECTORA_DATA has no folder ct/lidc_0314";
  // By eye, in slices of 1 mm: it ends at slice 221, clavicles beside it from 208 on.
  EXPECT_NEAR(anatomy->sternum.jugularNotch.z - anatomy->skin.front().z, 221, 3);
}

TEST(RealCts, OfAWholeThoraxHasAManubriumWithoutTheOssifiedCartilagesBesideIt) {
  const auto anatomy = anatomyOf("lidc_0314");
  if (!anatomy) GTEST_SKIP() << "PECTORA_DATA has no folder ct/lidc_0314";
  // By eye it is 52 to 58 mm wide where the first ribs' ossified cartilages touch it; with what they add, 68 and more.
  for (const std::vector<Vec3>& contour : anatomy->sternum.contours) {
    const auto [right, left] = std::minmax_element(contour.begin(), contour.end(), [](Vec3 a, Vec3 b) { return a.x < b.x; });
    EXPECT_LT(left->x - right->x, 63) << "at slice " << contour.front().z - anatomy->skin.front().z;
  }
}

TEST(RealCts, OfAWholeThoraxHasRibsOfALengthOnBothSides) {
  const auto anatomy = anatomyOf("lidc_0314");
  if (!anatomy) GTEST_SKIP() << "PECTORA_DATA has no folder ct/lidc_0314";
  // Their fronts fade; a rib that ends where it fades ends early, on one side by more than on the other.
  for (int number = 3; number <= 8; ++number) {
    const Rib *right = anatomy->rib(Side::right, number), *left = anatomy->rib(Side::left, number);
    ASSERT_TRUE(right && left) << number;
    EXPECT_NEAR(polylineLength(right->centerline) / polylineLength(left->centerline), 1, 0.07) << number;
  }
}

TEST(RealCts, OfAWholeThoraxHasAThinWallWhereNoLungShowsItBelowTheDiaphragm) {
  // In front, below the breasts, where no lung shows the wall: between the levels of the seventh and the ninth rib's front end.
  const auto anatomy = anatomyOf("lidc_0314");
  if (!anatomy) GTEST_SKIP() << "PECTORA_DATA has no folder ct/lidc_0314";
  const double low = anatomy->rib(Side::left, 9)->centerline.back().z, high = anatomy->rib(Side::right, 7)->centerline.back().z;
  int levels = 0;
  for (std::size_t n = 0; n < anatomy->skin.size(); ++n) {
    const LayerSlice &skin = anatomy->skin[n], &pleura = anatomy->pleura[n];
    if (skin.z < low || skin.z > high) continue;
    ++levels;
    for (const Vec3& p : pleura.points) {
      if (std::abs(p.x - pleura.points[pleura.points.size() / 2].x) > 90) continue;
      double nearest = 1e300;
      for (const Vec3& q : skin.points) nearest = std::min(nearest, distance(p, q));
      EXPECT_LT(nearest, 30) << "at x " << p.x << ", z " << p.z;   // 15 mm of cartilage and muscle, 15 of fat at the most
    }
  }
  EXPECT_GT(levels, 10);
}

TEST(RealCts, OfLowerRibsHaveAWallBehindTheFrontsOfRibsThatBeginAboveThem) {
  const auto anatomy = anatomyOf("cptac_c3l00189");
  if (!anatomy) GTEST_SKIP() << "PECTORA_DATA has no folder ct/cptac_c3l00189";
  // By eye: in slices 29 to 32 (of 5 mm) the inner wall crosses y = -67 on the left at x = 55 to 66, behind the sixth rib's front, which
  // cannot be tracked since its back is not in view; a wall that only follows the skin of the breast lies at 79.
  int levels = 0;
  for (const LayerSlice& pleura : anatomy->pleura) {
    if (pleura.z < -35 || pleura.z > -17) continue;
    for (std::size_t n = 1; n < pleura.points.size(); ++n) {
      const Vec3 a = pleura.points[n - 1], b = pleura.points[n];
      if ((a.y < -67) == (b.y < -67) || a.x < 0) continue;
      EXPECT_NEAR(a.x, 60, 10) << "at z " << pleura.z;
      ++levels;
    }
  }
  EXPECT_EQ(levels, 4);
}

TEST(RealCts, ThatShowTheAngleOfLouisButNeitherTheFirstNorTheLastRibAreCountedFromTheSecond) {
  const auto anatomy = anatomyOf("acrin_flt_013");
  if (!anatomy) GTEST_SKIP() << "PECTORA_DATA has no folder ct/acrin_flt_013";
  // By eye: the second rib ends beside the joint, at slice 41 of 4 mm; below it all to the tenth are in view on both sides.
  for (Side side : {Side::right, Side::left}) {
    for (int number = 2; number <= 10; ++number) EXPECT_NE(anatomy->rib(side, number), nullptr) << sideName(side) << number;
    ASSERT_NE(anatomy->rib(side, 2), nullptr);
    EXPECT_NEAR(anatomy->rib(side, 2)->centerline.back().z, anatomy->sternum.manubriosternalJoint.z, 12);
  }
}

TEST(RealCts, OfThickSlicesSaysSo) {
  const auto anatomy = anatomyOf("acrin_flt_013");
  if (!anatomy) GTEST_SKIP() << "PECTORA_DATA has no folder ct/acrin_flt_013";
  EXPECT_TRUE(std::any_of(anatomy->ranges.begin(), anatomy->ranges.end(), [](const SliceRange& r) { return r.what == "thick slices"; }));
}

}  // namespace
