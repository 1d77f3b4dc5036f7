#include "plugins/segmenter/thorax/doubts.h"
#include "noting_host.h"
#include "solids.h"

#include "kernel/stage/error.h"
#include "plugins/segmenter/thorax/segment.h"

#include <gtest/gtest.h>

using namespace pectora;
using namespace pectora::thorax;

namespace {

// A cylinder of water, 60 slices.
std::shared_ptr<Volume> water(double sliceSpacing) {
  auto ct = solids::air({80, 80, 60}, {3, 3, sliceSpacing});
  solids::fill(*ct, 40, solids::cylinder(120, 120, 90, 70));
  return ct;
}
std::vector<SliceRange> doubtsOf(const Volume& ct, std::vector<char> isClipped = {}) {
  const Body body = findBody(ct);
  isClipped.resize(body.lastSlice - body.firstSlice + 1, 0);
  return findDoubts(ct, body, isClipped, [&](int k) { return k * ct.grid.spacing.z; });
}

TEST(FindDoubts, SaysNothingOfACtThatIsRight) { EXPECT_TRUE(doubtsOf(*water(2)).empty()); }

TEST(FindDoubts, FindsMetalInTheBodyAndNotBesideIt) {
  auto ct = water(2);
  for (int k = 20; k <= 25; ++k)
    for (int j = 38; j < 42; ++j)
      for (int i = 38; i < 42; ++i) ct->hu[ct->grid.index(i, j, k)] = 3071, ct->hu[ct->grid.index(i - 36, j - 36, k + 20)] = 3071;
  const auto ranges = doubtsOf(*ct);
  ASSERT_EQ(ranges.size(), 1u);
  EXPECT_EQ(ranges[0].what, "metal");
  EXPECT_EQ(ranges[0].low, 40);
  EXPECT_EQ(ranges[0].high, 50);
  EXPECT_NE(sentence(ranges[0]).find("metal at z 40 to 50 mm"), std::string::npos);
}

TEST(FindDoubts, FindsSlicesInWhichTheBodyIsMissing) {
  auto ct = water(2);
  // A bridge of a few pixels keeps the two halves one body.
  for (int k = 30; k < 33; ++k)
    for (int j = 0; j < 80; ++j)
      for (int i = 0; i < 80; ++i)
        if (std::abs(i - 40) > 4 || std::abs(j - 40) > 4) ct->hu[ct->grid.index(i, j, k)] = -1000;
  const auto ranges = doubtsOf(*ct);
  ASSERT_EQ(ranges.size(), 1u);
  EXPECT_EQ(ranges[0].what, "missing slices");
  EXPECT_EQ(ranges[0].low, 60);
  EXPECT_EQ(ranges[0].high, 64);
}

TEST(FindDoubts, JoinsRunsOfClippedSkinThatAreHardlyApart) {
  std::vector<char> isClipped(60, 0);
  for (int s : {5, 6, 8, 30}) isClipped[s] = 1;
  const auto ranges = doubtsOf(*water(2), isClipped);
  ASSERT_EQ(ranges.size(), 2u);
  EXPECT_EQ(ranges[0].what, "clipped skin");
  EXPECT_EQ(ranges[0].low, 10);
  EXPECT_EQ(ranges[0].high, 16);
  EXPECT_EQ(ranges[1].low, 60);
}

TEST(FindDoubts, SaysThatSlicesAreThickAndSegmentStopsWhereTheyAreTooThick) {
  const auto ranges = doubtsOf(*water(5));
  ASSERT_EQ(ranges.size(), 1u);
  EXPECT_EQ(ranges[0].what, "thick slices");
  NotingHost host;
  try {
    segment(water(12), {}, host);
    FAIL() << "12 mm are too thick";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("too thick"), std::string::npos) << error.what();
  }
}

}  // namespace
