#include "plugins/comparer/anatomy/judge.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pectora;

namespace {

double figure(const std::vector<Fact>& facts, const std::string& name) {
  for (const Fact& f : facts)
    if (f.name == name) return std::get<double>(f.value);
  ADD_FAILURE() << "no figure " << name;
  return NAN;
}

// Straight ribs, a square sternum, flat layers.
Anatomy simple() {
  Anatomy a;
  for (int n = 1; n <= 12; ++n)
    for (Side side : {Side::right, Side::left})
      a.ribs.push_back({side, n, {{side == Side::right ? -20. : 20., 0, -20. * n}, {side == Side::right ? -120. : 120., -50, -20. * n - 30}}, true, true});
  for (double z = -150; z <= -40; z += 5) {
    a.sternum.contours.push_back({{-15, -80, z}, {15, -80, z}, {15, -70, z}, {-15, -70, z}});
    a.skin.push_back({z, {{-150, -90, z}, {0, -90, z}, {150, -90, z}}, false});
    a.pleura.push_back({z, {{-120, -65, z}, {0, -65, z}, {120, -65, z}}, false});
  }
  a.sternum.jugularNotch = {0, -80, -40};
  a.sternum.manubriosternalJoint = {0, -80, -70};
  a.sternum.xiphisternalJoint = {0, -80, -150};
  a.metrics.push_back({-140, 240, 60, 90});
  return a;
}

Truth truthOf(const Anatomy& a) {
  Truth t;
  t.anatomy = std::make_shared<Anatomy>(a);
  t.hallerIndex = 4;
  t.correctionIndex = 100.0 * 30 / 90;
  return t;
}

}  // namespace

TEST(JudgeAnatomy, FindsNoFaultWithTheTruthItself) {
  const Anatomy a = simple();
  const auto facts = judgeAnatomy(a, nullptr, truthOf(a));
  EXPECT_EQ(figure(facts, "ribs_rightly_numbered"), 20);
  for (const char* name : {"rib_rms", "sternum_mean", "skin_mean_absolute", "pleura_mean_absolute", "haller_error", "correction_index_error", "torsion_error"})
    EXPECT_NEAR(figure(facts, name), 0, 1e-9) << name;
  EXPECT_TRUE(std::isnan(figure(facts, "cartilage_rms")));
}

TEST(JudgeAnatomy, MeasuresAShiftAsItsLength) {
  const Anatomy a = simple();
  Anatomy shifted = a;
  for (LayerSlice& s : shifted.skin)
    for (Vec3& p : s.points) p.y -= 2;
  for (Rib& r : shifted.ribs)
    for (Vec3& p : r.centerline) p.z += 3 * norm(Vec3{100, 50, 30}) / norm(Vec3{100, 50, 0});  // 3 mm across the rib
  const auto facts = judgeAnatomy(shifted, nullptr, truthOf(a));
  EXPECT_NEAR(figure(facts, "skin_mean_absolute"), 2, 1e-9);
  EXPECT_NEAR(figure(facts, "rib_rms"), 3, 0.1);
}

TEST(JudgeAnatomy, CountsWrongNumbersAndMissingEnds) {
  const Anatomy a = simple();
  Anatomy wrong = a;
  for (Rib& r : wrong.ribs) r.number = r.number == 12 ? 0 : r.number + 1;
  EXPECT_EQ(figure(judgeAnatomy(wrong, nullptr, truthOf(a)), "ribs_rightly_numbered"), 0);
  Anatomy cut = a;
  for (Rib& r : cut.ribs) r.centerline[1] = lerp(r.centerline[0], r.centerline[1], 0.8);
  EXPECT_GT(figure(judgeAnatomy(cut, nullptr, truthOf(a)), "rib_rms"), 3);
}

TEST(JudgeAnatomy, LeavesOutWhatOfACartilageLiesWithinTheSternum) {
  const Anatomy a = simple();
  Truth truth = truthOf(a);
  // The truth goes on to 5 mm from the midline, the cartilage that was found ends at the bone, 15 mm from it.
  truth.cartilages.push_back({Side::left, 4, 0, {{60, -75, -90}, {5, -75, -90}}});
  RibCage cage;
  cage.cartilages.push_back({Side::left, 4, {3, clampedKnots(4, 3), {{60, -75, -90}, {45, -75, -90}, {30, -75, -90}, {15, -75, -90}}}, 0, 0});
  const auto facts = judgeAnatomy(a, &cage, truth);
  // The last point that is kept lies less than one step of 2 mm within the bone.
  EXPECT_LT(figure(facts, "cartilage_rms"), 0.5);
  EXPECT_EQ(figure(facts, "cartilages_found"), 1);
}
