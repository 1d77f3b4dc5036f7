// The sternum's outline where something touches it.
#include "plugins/segmenter/thorax/sternum_outline.h"
#include "solids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace pectora;
using namespace pectora::thorax;

namespace {

constexpr double kMiddle = 60, kHalfWide = 24, kHalfDeep = 7;

double box(Vec3 p, double x, double y, double halfWide, double halfDeep) { return std::max(std::abs(p.x - x) - halfWide, std::abs(p.y - y) - halfDeep); }

/// A manubrium of 48 x 14 mm; on its right the head of a clavicle, joined to it by a bridge of `bridgeHu`.
Field manubrium(double bridgeHu) {
  const auto ct = solids::air({120, 90, 3}, {1, 1, 1});
  for (auto& hu : ct->hu) hu = 40;
  solids::fill(*ct, bridgeHu, [](Vec3 p) { return box(p, kMiddle - 26, 46, 4, 3); });
  solids::fill(*ct, 700, [](Vec3 p) { return box(p, kMiddle, 45, kHalfWide, kHalfDeep); });
  solids::fill(*ct, 700, [](Vec3 p) { return std::hypot(p.x - (kMiddle - 38), p.y - 50) - 10; });
  Box whole;
  whole.high = ct->grid.size;
  return Field(*ct, whole, 0.5);
}

SternumWindow windowOf(double touchMm) { return {{kMiddle, 45, 1}, 34, 20, touchMm}; }

TEST(OutlineIn, PartsAClavicleThatTouchesTheManubrium) {
  const SternumSlice slice = outlineIn(manubrium(210), 1, windowOf(4), 160);
  ASSERT_TRUE(slice.isSeen);
  // To a pixel, 0.7 mm, and what blur moves an edge of 700 HU in 40 at a level of up to 330: half a pixel more.
  EXPECT_NEAR(sidesOf(slice.contour).right, kMiddle - kHalfWide, 1.3);
  EXPECT_NEAR(sidesOf(slice.contour).left, kMiddle + kHalfWide, 1.3);
  EXPECT_NEAR(columnAt(slice.contour, kMiddle).front, 45 - kHalfDeep, 1.3);
  EXPECT_NEAR(columnAt(slice.contour, kMiddle).back, 45 + kHalfDeep, 1.3);
}

TEST(OutlineIn, TakesInAllBoneWhereNothingCanTouch) {
  const SternumSlice slice = outlineIn(manubrium(210), 1, windowOf(0), 160);
  EXPECT_LT(sidesOf(slice.contour).right, kMiddle - 33);
}

TEST(OutlineIn, IsTheSameWithAndWithoutATouchWhereThereIsNone) {
  const Field field = manubrium(40);
  const SternumSlice a = outlineIn(field, 1, windowOf(4), 160), b = outlineIn(field, 1, windowOf(0), 160);
  ASSERT_EQ(a.contour.size(), b.contour.size());
  for (std::size_t n = 0; n < a.contour.size(); ++n) EXPECT_EQ(a.contour[n].x, b.contour[n].x);
  EXPECT_NEAR(sidesOf(a.contour).right, kMiddle - kHalfWide, 1.3);
}

TEST(CutSides, AreThoseWhereTheOutlineComesToTheWindowsBorder) {
  SternumSlice slice;
  slice.isSeen = true;
  slice.contour = {{26.5, 40}, {84, 40}, {84, 50}, {26.5, 50}};
  const CutSides cut = cutSides(slice, windowOf(0), 1.4);
  EXPECT_TRUE(cut.right);
  EXPECT_FALSE(cut.left);
}

}  // namespace
