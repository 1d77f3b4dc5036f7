#include "plugins/effect/common/pack_svd.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace pectora::cells;

namespace {

// In its lanes: any matrix, a rotation, a reflection, rank 2, rank 1, zero, equal values, and values 1e6 apart.
void fill(Pack (&f)[3][3]) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  for (auto& row : f)
    for (Pack& e : row)
      for (int lane = 0; lane < kLanes; ++lane) e[lane] = number(random);
  const double c = std::cos(0.4), s = std::sin(0.4);
  const double given[7][3][3] = {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}, {{-1, 0, 0}, {0, 1, 0}, {0, 0, 2}}, {{1, 2, 3}, {2, 4, 6}, {1, 0, 1}},
                                 {{1, 2, 3}, {2, 4, 6}, {-1, -2, -3}}, {}, {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}, {{1e6, 0, 0}, {0, 0.5, 0.1}, {0, 0.1, 1}}};
  for (int n = 0; n < 7; ++n)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) f[i][j][n + 1] = given[n][i][j];
}

}  // namespace

TEST(PackSvd, TwoRotationsAndTheSingularValuesMakeTheMatrixAgain) {
  Pack f[3][3], u[3][3], s[3], v[3][3];
  fill(f);
  decompose(f, u, s, v);
  for (int lane = 0; lane < kLanes; ++lane) {
    // V comes from F^T F, whose rounding is that of the largest value.
    const double tolerance = 1e-14 * (1 + s[0][lane]);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        double again = 0, uu = 0, vv = 0;
        for (int k = 0; k < 3; ++k) {
          again += u[i][k][lane] * s[k][lane] * v[j][k][lane];
          uu += u[i][k][lane] * u[j][k][lane];
          vv += v[i][k][lane] * v[j][k][lane];
        }
        EXPECT_NEAR(again, f[i][j][lane], 10 * tolerance) << lane;
        EXPECT_NEAR(uu, i == j, 1e-13) << lane;
        EXPECT_NEAR(vv, i == j, 1e-13) << lane;
      }
    EXPECT_GE(s[0][lane], s[1][lane] - 1e-12);
    EXPECT_GE(s[1][lane], std::abs(s[2][lane]) - tolerance);
  }
  EXPECT_NEAR(s[2][2], -1, 1e-14) << "the reflection's sign";
}
