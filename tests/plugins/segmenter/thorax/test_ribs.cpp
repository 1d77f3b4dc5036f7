#include "solids.h"

#include "kernel/value/curve.h"
#include "plugins/segmenter/thorax/rib_fade.h"
#include "plugins/segmenter/thorax/ribs.h"

#include <gtest/gtest.h>

#include <numbers>

using namespace pectora;
using namespace pectora::thorax;

namespace {

constexpr double kPi = std::numbers::pi;

/// A ring of radius 60 mm about (100, 100), falling 40 mm from the back to the front: a rib as a helix, right side.
Vec3 ringPoint(double degrees) {
  const double a = degrees * kPi / 180;
  return {100 - 60 * std::sin(a), 100 - 60 * std::cos(a), 30 + 40 * (degrees / 180)};
}

/// CT with that rib as a tube of radius 5 mm from 20 to 170 degrees, cortex above marrow.
std::shared_ptr<Volume> ringCt(double sliceSpacing) {
  auto ct = solids::air({200, 200, int(100 / sliceSpacing)}, {1, 1, sliceSpacing});
  std::fill(ct->hu.begin(), ct->hu.end(), std::int16_t(40));
  std::vector<Vec3> line;
  for (double d = 20; d <= 170; d += 1) line.push_back(ringPoint(d));
  solids::fill(*ct, 500, [&](Vec3 p) {
    double nearest = 1e9;
    if (std::abs(std::hypot(p.x - 100, p.y - 100) - 60) > 8) return nearest;
    for (const Vec3& q : line) nearest = std::min(nearest, distance(p, q));
    return nearest - 5;
  });
  return ct;
}

Spine straightSpine(int slices, double sliceSpacing) {
  Spine spine;
  for (int k = 0; k < slices; ++k) {
    spine.front.push_back({100, 130, k * sliceSpacing});
    spine.centre.push_back({100, 145, k * sliceSpacing});
  }
  spine.lastSlice = slices - 1;
  return spine;
}

double rmsTo(const std::vector<Vec3>& line, double& from, double& to) {
  double sum = 0;
  std::size_t count = 0;
  from = 180, to = 0;
  for (const Vec3& p : line) {
    double nearest = 1e9, at = 0;
    for (double d = 20; d <= 170; d += 0.25)
      if (distance(p, ringPoint(d)) < nearest) nearest = distance(p, ringPoint(d)), at = d;
    // Beyond the ends there is no axis to compare with.
    if (at > 20 && at < 170) sum += nearest * nearest, ++count;
    from = std::min(from, at), to = std::max(to, at);
  }
  return std::sqrt(sum / double(count));
}

class RibOfARing : public testing::TestWithParam<double> {};

TEST_P(RibOfARing, IsTrackedAsOneBodyAndCentred) {
  const double sliceSpacing = GetParam();
  const auto ct = ringCt(sliceSpacing);
  const Field field(*ct, Box{{0, 0, 0}, ct->grid.size}, 1);
  const Spine spine = straightSpine(ct->grid.size[2], sliceSpacing);
  const Fan fan = makeFan(Side::right, spine, ct->grid.spacing);
  const std::vector<Track> tracks = trackSections(findSections(fan, field, {}), {});
  ASSERT_EQ(tracks.size(), 1u);
  EXPECT_GE(tracks[0].backPlane(), 150);
  EXPECT_LE(tracks[0].frontPlane(), 30);
  std::vector<Vec3> rough;
  for (const Track::Item& item : tracks[0].items) rough.push_back(fan.position(item.plane, item.section.shape.centroid));
  const MarchedRib rib = marchRib(rough, field, spine, 160);
  double from, to;
  EXPECT_LT(rmsTo(rib.line, from, to), sliceSpacing > 4 ? 0.8 : 0.4);  // half a pixel; a quarter of a thick slice
  EXPECT_LT(from, 25);
  EXPECT_GT(to, 160);
  EXPECT_TRUE(rib.reachesJunction);
  EXPECT_GT(rib.line.front().y, rib.line.back().y);  // from the vertebra to the front
}
INSTANTIATE_TEST_SUITE_P(SliceSpacings, RibOfARing, testing::Values(1.0, 2.5, 5.0));

TEST(CutAcross, FindsTheAxisOfATubeFromBesideIt) {
  auto ct = solids::air({60, 60, 60}, {1, 1, 1});
  solids::fill(*ct, 600, solids::cylinder(30, 31, 5, 7));
  const Field field(*ct, Box{{0, 0, 0}, {60, 60, 60}}, 0.8);
  const Cut cut = cutAcross(field, {32, 29, 30}, {0, 0, 1}, 160);
  ASSERT_TRUE(cut.isFound);
  EXPECT_NEAR(cut.centre.x, 30, 0.1);
  EXPECT_NEAR(cut.centre.y, 31, 0.1);
  EXPECT_FALSE(cutAcross(field, {10, 10, 30}, {0, 0, 1}, 160).isFound);
}

TEST(CutAcross, SaysWhenTheBoneIsTooLargeForARib) {
  auto ct = solids::air({60, 60, 60}, {1, 1, 1});
  solids::fill(*ct, 600, solids::cylinder(30, 30, 15, 15));
  const Field field(*ct, Box{{0, 0, 0}, {60, 60, 60}}, 0.8);
  const Cut cut = cutAcross(field, {30, 30, 30}, {0, 0, 1}, 160);
  EXPECT_FALSE(cut.isFound);
  EXPECT_TRUE(cut.isMerged);
}

TEST(CutAcross, PartsTwoRibsThatTouch) {
  auto ct = solids::air({60, 60, 60}, {1, 1, 1});
  std::fill(ct->hu.begin(), ct->hu.end(), std::int16_t(40));
  solids::fill(*ct, 600, solids::cylinder(30, 24, 5, 5.75));
  solids::fill(*ct, 600, solids::cylinder(30, 38, 5, 5.75));  // 2.5 mm apart: one contour at 160 HU
  const Field field(*ct, Box{{0, 0, 0}, {60, 60, 60}}, 1);
  const Cut cut = cutAcross(field, {30, 25, 30}, {0, 0, 1}, 160);
  ASSERT_TRUE(cut.isFound);
  EXPECT_NEAR(cut.centre.x, 30, 0.2);
  EXPECT_NEAR(cut.centre.y, 24, 0.5);
}

TEST(RibFade, FollowsARibThatFadesTowardsItsEnd) {
  // By 2 % of the usual brightness with every cut, from 24 cuts before the end.
  RibFade fade({}, 400);
  for (double part = 1; part > 0.56; part -= 0.02) {
    ASSERT_TRUE(fade.goesOn(400 * part)) << part;
    fade.add(400 * part);
  }
  EXPECT_FALSE(fade.goesOn(400 * 0.54)) << "too faint for a rib";
  EXPECT_FALSE(fade.goesOn(400 * 0.70)) << "brighter again";
}

TEST(RibFade, StopsAtAStepDown) {
  const RibFade fade(std::vector<double>(20, 400.0), 400);
  EXPECT_TRUE(fade.goesOn(0.9 * 400));
  EXPECT_FALSE(fade.goesOn(0.8 * 400));
}

/// Ribs of both sides at these heights (local z of their backs).
std::vector<FoundRib> ladder(const std::vector<double>& right, const std::vector<double>& left) {
  std::vector<FoundRib> ribs;
  for (Side side : {Side::right, Side::left})
    for (double z : side == Side::right ? right : left) {
      FoundRib rib;
      rib.side = side;
      rib.backHeight = z;
      rib.body.line = {{0, 100, z}, {0, 50, z - 30}};
      ribs.push_back(rib);
    }
  return ribs;
}
std::vector<int> numbers(const std::vector<FoundRib>& ribs, Side side) {
  std::vector<int> result;
  for (const FoundRib& r : ribs)
    if (r.side == side) result.push_back(r.number);
  return result;
}

TEST(NumberRibs, CountsDownFromTheFirstIfItIsInView) {
  std::vector<FoundRib> ribs = ladder({250, 230, 208, 185}, {252, 233, 211, 188});
  EXPECT_EQ(numberRibs(ribs, 150, 290), Counting::fromFirst);
  EXPECT_EQ(numbers(ribs, Side::right), (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(numbers(ribs, Side::left), (std::vector<int>{1, 2, 3, 4}));
}

TEST(NumberRibs, LeavesAGapWhereOneSideLacksARib) {
  std::vector<FoundRib> ribs = ladder({250, 208, 185}, {252, 230, 211, 188});
  numberRibs(ribs, 150, 290);
  EXPECT_EQ(numbers(ribs, Side::right), (std::vector<int>{1, 3, 4}));
}

TEST(NumberRibs, CountsUpFromTheLastIfOnlyThatIsInView) {
  std::vector<FoundRib> ribs = ladder({190, 165, 140, 115}, {191, 166, 141, 116});
  EXPECT_EQ(numberRibs(ribs, 20, 195), Counting::fromLast);
  EXPECT_EQ(numbers(ribs, Side::right), (std::vector<int>{9, 10, 11, 12}));
}

TEST(NumberRibs, GivesNoNumbersIfNeitherEndIsInView) {
  std::vector<FoundRib> ribs = ladder({190, 165, 140}, {191, 166, 141});
  EXPECT_EQ(numberRibs(ribs, 120, 195), Counting::none);
  EXPECT_EQ(numbers(ribs, Side::left), (std::vector<int>{0, 0, 0}));
}

TEST(NumberRibs, CountsFromTheRibThatRunsToTheAngleOfLouisIfNeitherEndIsInView) {
  // Fronts 30 mm below the backs and 80 mm before them, falling by 6 mm in their last 24; the notches are 20 mm further inwards.
  std::vector<FoundRib> ribs = ladder({190, 165, 140}, {191, 166, 141});
  for (FoundRib& rib : ribs) rib.body.line = {{0, 120, rib.backHeight}, {0, 64, rib.backHeight - 24}, {0, 40, rib.backHeight - 30}}, rib.body.reachesJunction = true;
  const auto notches = [](double z) { return SecondNotches{Vec3{0, 20, z}, Vec3{0, 20, z}}; };
  EXPECT_EQ(numberRibs(ribs, 120, 195, notches(133)), Counting::fromSternum);
  EXPECT_EQ(numbers(ribs, Side::right), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(numbers(ribs, Side::left), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(numberRibs(ribs, 120, 195, notches(120)), Counting::none) << "midway between two ribs";
}

TEST(NumberRibs, OfNothingOrOneRibIsNone) {
  std::vector<FoundRib> none, one = ladder({100}, {});
  EXPECT_EQ(numberRibs(none, 0, 300), Counting::none);
  EXPECT_EQ(numberRibs(one, 0, 300), Counting::none);
}

TEST(CutAcross, PartsARibFromOneThatTouchesItWhenItsUsualSizeIsKnown) {
  // Two slender ribs that touch: together still small enough for one rib.
  auto ct = solids::air({60, 60, 60}, {1, 1, 1});
  std::fill(ct->hu.begin(), ct->hu.end(), std::int16_t(40));
  solids::fill(*ct, 600, solids::cylinder(30, 25, 3, 5));
  solids::fill(*ct, 600, solids::cylinder(30, 37, 3, 5));  // 2 mm apart: one contour at 160 HU
  const Field field(*ct, Box{{0, 0, 0}, {60, 60, 60}}, 1);
  EXPECT_GT(distance(cutAcross(field, {30, 26, 30}, {0, 0, 1}, 160).centre, {30, 25, 30}), 3) << "both at once";
  const Cut cut = cutAcross(field, {30, 26, 30}, {0, 0, 1}, 160, M_PI * 3 * 5);
  ASSERT_TRUE(cut.isFound);
  EXPECT_NEAR(cut.centre.y, 25, 0.5);
  EXPECT_GT(cut.meanHu, 400);
}

TEST(PatientTurn, IsTheAngleOfTheLinesBetweenTheTwoSides) {
  std::vector<FoundRib> ribs;
  const double a = 7 * M_PI / 180;
  for (int number = 1; number <= 4; ++number)
    for (Side side : {Side::right, Side::left}) {
      FoundRib rib;
      rib.side = side, rib.number = number, rib.body.reachesVertebra = true;
      for (double t = 0; t <= 1; t += 0.05) {
        const double x = (side == Side::right ? -1 : 1) * (20 + 100 * std::sin(2.5 * t)), y = -120 * t;
        rib.body.line.push_back({std::cos(a) * x - std::sin(a) * y, std::sin(a) * x + std::cos(a) * y, -20.0 * number});
      }
      ribs.push_back(rib);
    }
  EXPECT_NEAR(patientTurn(ribs), 7, 1e-6);
  ribs.resize(4);
  EXPECT_EQ(patientTurn(ribs), 0) << "two pairs are too few";
}

}  // namespace

TEST(PartMergedFronts, PutsAFrontBackThatStrayedToTheRibAbove) {
  // Two arcs of 200 mm with a radius of 130 mm, one 18 mm above the other; the lower one's last 30 mm climb to the upper one.
  const auto arc = [](double s, double z) { return Vec3{130 * std::sin(s / 130), 130 * std::cos(s / 130), z}; };
  std::vector<FoundRib> ribs(3);
  for (double s = 0; s <= 200; s += 2) {
    ribs[0].body.line.push_back(arc(s, 18));
    ribs[1].body.line.push_back(arc(s, s < 170 ? 0 : 16 * (s - 170) / 30));
    ribs[2].body.line.push_back(arc(s, -18));
  }
  const std::vector<FoundRib> before = ribs;
  partMergedFronts(ribs);
  EXPECT_EQ(ribs[2].body.line, before[2].body.line);
  // Going on with the bend of the 40 mm before: on a circle that is exact but for the polyline's own corners.
  for (const std::size_t r : {0, 1}) {
    ASSERT_EQ(ribs[r].body.line.size(), before[r].body.line.size());
    EXPECT_LT(distance(ribs[r].body.line.back(), arc(200, r == 0 ? 18 : 0)), 2) << r;
  }
}
