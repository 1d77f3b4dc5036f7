#include "kernel/physics/calibration.h"

#include <algorithm>
#include <cmath>

namespace pectora {

const std::array<std::array<int, 2>, 8>& bendOffsets() {
  static constexpr std::array<std::array<int, 2>, 8> offsets{
      {{0, 2}, {2, 0}, {1, 2}, {2, 1}, {-1, 2}, {-2, 1}, {2, 2}, {-2, 2}}};
  return offsets;
}

LayerStiffness calibrateLayer(double e2, double a, double b, double bendShare) {
  // Direction 1 runs along the rows' normal (spacing a between rows), direction 2 along a row (spacing b).
  const double cell = a * b;
  const double n1122 = 3.0 / 8 * e2, n1111 = 9.0 / 8 * e2;

  // Bend springs: one weight k/L^2 for all, chosen by their share of N1122.
  double b1111 = 0, b2222 = 0, b1122 = 0;
  for (const auto& [rows, columns] : bendOffsets()) {
    const double d1 = rows * a, d2 = columns * b;
    b1111 += d1 * d1 * d1 * d1 / cell;
    b2222 += d2 * d2 * d2 * d2 / cell;
    b1122 += d1 * d1 * d2 * d2 / cell;
  }
  LayerStiffness k;
  k.bendWeight = bendShare * n1122 / b1122;

  // Two diagonals a cell carry the rest of N1122.
  const double diagonal = a * a + b * b;
  const double shearWeight = (n1122 - k.bendWeight * b1122) * cell / (2 * a * a * b * b);
  k.shear = shearWeight * diagonal;

  // Stretch springs carry what is left of N1111 and N2222.
  const double left1 = n1111 - k.bendWeight * b1111 - 2 * shearWeight * a * a * a * a / cell;
  const double left2 = n1111 - k.bendWeight * b2222 - 2 * shearWeight * b * b * b * b / cell;
  const double floor = 0.02 * n1111;
  k.isIsotropic = left1 >= floor && left2 >= floor;
  k.stretchRows = std::max(left1, floor) * cell / (a * a);
  k.stretchColumns = std::max(left2, floor) * cell / (b * b);
  return k;
}

CrossStiffness calibrateCross(double youngsModulus, double a, double b, double thickness, int rows, int columns) {
  CrossStiffness cross{rows, columns, {}};
  std::vector<double> radiusSquared;
  for (int r = -rows; r <= rows; ++r)
    for (int c = -columns; c <= columns; ++c) radiusSquared.push_back(r * a * r * a + c * b * c * b);
  const double target = 2.0 / 3 * thickness * thickness;
  // Mean of r^2 under the weights exp(-beta r^2): falls as beta grows.
  const auto meanRadius = [&](double beta) {
    double sum = 0, moment = 0;
    for (const double square : radiusSquared) {
      const double w = std::exp(-beta * square);
      sum += w;
      moment += w * square;
    }
    return moment / sum;
  };
  const double widest = radiusSquared.front();
  double beta = 0;
  cross.isFeasible = target < 0.999 * widest;
  if (cross.isFeasible) {
    // Exponents stay below 700 in size.
    double low = -600 / widest, high = 600 / widest;
    for (int i = 0; i < 200; ++i) {
      beta = 0.5 * (low + high);
      (meanRadius(beta) > target ? low : high) = beta;
    }
  }
  double sum = 0;
  for (const double square : radiusSquared) sum += std::exp(-beta * square);
  const double total = 1.2 * youngsModulus * a * b / (thickness * thickness * thickness);
  for (const double square : radiusSquared) cross.stiffness.push_back(total * std::exp(-beta * square) / sum * (square + thickness * thickness));
  return cross;
}

}  // namespace pectora
