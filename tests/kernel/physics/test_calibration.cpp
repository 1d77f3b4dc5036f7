#include "kernel/physics/calibration.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pectora;

namespace {

// The sheet's tensor from its springs: C = sum k / L^2 d d d d / cell, over each pair of a cell once.
struct Sheet {
  double n1111 = 0, n2222 = 0, n1122 = 0;
  double a, b;
  void add(int rows, int columns, double k) {
    const double x = rows * a, y = columns * b, weight = k / (x * x + y * y) / (a * b);
    n1111 += weight * x * x * x * x;
    n2222 += weight * y * y * y * y;
    n1122 += weight * x * x * y * y;
  }
};

Sheet sheetOf(const LayerStiffness& k, double a, double b) {
  Sheet sheet{0, 0, 0, a, b};
  sheet.add(1, 0, k.stretchRows);
  sheet.add(0, 1, k.stretchColumns);
  sheet.add(1, 1, k.shear);
  sheet.add(-1, 1, k.shear);
  for (const auto& [r, c] : bendOffsets()) sheet.add(r, c, k.bendWeight * (r * r * a * a + c * c * b * b));
  return sheet;
}

}  // namespace

TEST(LayerCalibration, OfSquareCellsGivesThePublishedConstants) {
  // k_shear = 3/8 E2 and k_stretch = 3/4 E2 without bend springs.
  const LayerStiffness k = calibrateLayer(0.36, 8, 8, 0);
  EXPECT_NEAR(k.shear, 0.375 * 0.36, 1e-12);
  EXPECT_NEAR(k.stretchRows, 0.75 * 0.36, 1e-12);
  EXPECT_NEAR(k.stretchColumns, 0.75 * 0.36, 1e-12);
}

TEST(LayerCalibration, MakesAnIsotropicSheetOfAnyModerateCell) {
  for (const double b : {6.0, 8.0, 10.0}) {
    for (const double share : {0.0, 0.2}) {
      const LayerStiffness k = calibrateLayer(0.36, 8, b, share);
      ASSERT_TRUE(k.isIsotropic) << b;
      const Sheet sheet = sheetOf(k, 8, b);
      EXPECT_NEAR(sheet.n1111, 9.0 / 8 * 0.36, 1e-12);
      EXPECT_NEAR(sheet.n2222, 9.0 / 8 * 0.36, 1e-12);
      EXPECT_NEAR(sheet.n1122, 3.0 / 8 * 0.36, 1e-12);
    }
  }
}

TEST(LayerCalibration, SaysWhereCellsAreTooOblong) {
  const LayerStiffness k = calibrateLayer(0.36, 8, 20, 0);
  EXPECT_FALSE(k.isIsotropic);
  EXPECT_GT(k.stretchRows, 0);
  EXPECT_GT(k.stretchColumns, 0);
}

TEST(CrossCalibration, MeetsTheTwoMomentsWhereItCan) {
  // sum w = 1.2 E A / H^3 and sum w dx^2 = 0.4 E A / H, for w = k / L^2.
  const double e = 0.01, a = 8, h = 20;
  const CrossStiffness k = calibrateCross(e, a, a, h);
  ASSERT_TRUE(k.isFeasible);
  double sum = 0, momentX = 0, momentY = 0;
  for (int i = 0; i < 25; ++i) {
    const double x = (i / 5 - 2) * a, y = (i % 5 - 2) * a, w = k.stiffness[i] / (x * x + y * y + h * h);
    EXPECT_GT(k.stiffness[i], 0);
    sum += w;
    momentX += w * x * x;
    momentY += w * y * y;
  }
  EXPECT_NEAR(sum / (1.2 * e * a * a / (h * h * h)), 1, 1e-12);
  EXPECT_NEAR(momentX / (0.4 * e * a * a / h), 1, 1e-9);
  EXPECT_NEAR(momentY / (0.4 * e * a * a / h), 1, 1e-9);
}

TEST(CrossCalibration, IsUniformAtTheThicknessOfSqrtSixSpacings) {
  const CrossStiffness k = calibrateCross(0.01, 8, 8, std::sqrt(6.0) * 8);
  double least = INFINITY, greatest = 0;
  for (int i = 0; i < 25; ++i) {
    const double x = (i / 5 - 2) * 8, y = (i % 5 - 2) * 8, w = k.stiffness[i] / (x * x + y * y + 6 * 64);
    least = std::min(least, w);
    greatest = std::max(greatest, w);
  }
  // Mean r^2 of the 5 x 5 stencil is 4 a^2, and 2/3 H^2 = 4 a^2.
  EXPECT_NEAR(greatest / least, 1, 1e-9);
}

TEST(CrossCalibration, ReachesTheThicknessOfTwoSqrtThreeSpacingsAndNoMore) {
  EXPECT_TRUE(calibrateCross(0.01, 8, 8, 0.99 * 2 * std::sqrt(3.0) * 8).isFeasible);
  EXPECT_FALSE(calibrateCross(0.01, 8, 8, 1.01 * 2 * std::sqrt(3.0) * 8).isFeasible);
}

TEST(CrossCalibration, WithItsReachInMmConvergesAsTheSpacingShrinksAndWithItsReachInPointsDoesNot) {
  // What of a wave of the pleura, pushed outwards, comes through a flat wall of 20 mm: the average of it over the springs with
  // their stiffness in depth, sum k (H / L)^2 cos(q x) / sum k (H / L)^2.
  const double h = 20, q = 2 * M_PI / 80;
  const auto transfer = [&](double a, int reach) {
    const CrossStiffness k = calibrateCross(0.01, a, a, h, reach, reach);
    double sum = 0, wave = 0;
    for (int r = -reach; r <= reach; ++r)
      for (int c = -reach; c <= reach; ++c) {
        const double w = k.at(r, c) * h * h / (h * h + a * a * (r * r + c * c));
        sum += w;
        wave += w * std::cos(q * a * c);
      }
    return wave / sum;
  };
  const double coarse = transfer(10, 2), middle = transfer(5, 4), fine = transfer(2.5, 8), finest = transfer(1.25, 16);
  EXPECT_LT(std::abs(finest - fine), 0.6 * std::abs(fine - middle));
  EXPECT_LT(std::abs(fine - middle), 0.6 * std::abs(middle - coarse));
  EXPECT_LT(std::abs(finest - fine), 0.01);
  // An elastic slab of 20 mm lets 0.723 of it through; springs that reach two points ever less smooth it away.
  EXPECT_NEAR(finest, 0.7, 0.1);
  EXPECT_GT(transfer(1.25, 2), 0.95);
}
