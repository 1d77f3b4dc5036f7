// The solid against CalculiX on the same mesh.
#include "tests/plugins/effect/common/slab.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

using namespace pectora;

namespace {

// The largest difference between two skins, over the bump's height.
double difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double bump) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, distance(a[i], b[i]));
  return largest / bump;
}

void compare(double nu, double bump, bool isFinite) {
  if (std::string(PECTORA_CCX).empty()) GTEST_SKIP() << "CalculiX (ccx) is not installed";
  const Slab slab(24, 4, nu, bump);
  const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
  const std::vector<Vec3> theirs = solveByCalculix(PECTORA_CCX, slab, "C3D8I", isFinite, scratch(test));
  const std::vector<Vec3> ours = solveHere(slab, 1e-7);
  EXPECT_LT(difference(ours, theirs, bump), 0.01);
}

}  // namespace

TEST(Calculix, AgreesOnASmallLift) { compare(0.45, 0.1, false); }
TEST(Calculix, AgreesOnALiftOfFifteenMillimetres) { compare(0.45, 15, true); }
TEST(Calculix, AgreesWhereVolumeIsNearlyKept) { compare(0.49, 15, true); }
