#include "polar_table.h"

#include "smooth.h"

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

namespace pectora::phantom {
namespace {

// The coarse grid of the fit: half the circle, for the surface is symmetric.
constexpr int kCoarseAngles = 61, kCoarseLevels = 121;
constexpr double kCoarseAngle = kPi / (kCoarseAngles - 1), kCoarseStep = 5;
constexpr double kSmoothness = 0.15;  // penalty of a second difference against a sample's weight of 1

int mirrored(int i, int count) { return i < 0 ? -i : i >= count ? 2 * (count - 1) - i : i; }

double cubic(double a, double b, double c, double d, double t) {  // Catmull-Rom
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

}  // namespace

double polarCenterY(double z) { return -40 * step(0, -120, z); }

double polarAngle(double x, double y, double z) { return std::atan2(x, polarCenterY(z) - y); }

PolarTable::PolarTable() : values_(std::size_t(kAngles) * levels()) {}

int PolarTable::levels() const { return int((kTop - kBottom) / kStep) + 1; }
double PolarTable::angle(int i) { return radians(i - 180.0); }

PolarTable PolarTable::fit(const std::vector<PolarSample>& samples) {
  const int unknowns = kCoarseAngles * kCoarseLevels;
  const auto node = [](int i, int j) { return j * kCoarseAngles + i; };
  std::vector<Eigen::Triplet<double>> triplets;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
  const auto addRow = [&](const int* nodes, const double* factors, int count, double value, double weight) {
    for (int a = 0; a < count; ++a) {
      right[nodes[a]] += weight * factors[a] * value;
      for (int b = 0; b < count; ++b) triplets.emplace_back(nodes[a], nodes[b], weight * factors[a] * factors[b]);
    }
  };

  // Samples, bilinear in the coarse grid.
  for (const PolarSample& sample : samples) {
    const Vec3 p = sample.point;
    const double radius = std::hypot(p.x, p.y - polarCenterY(p.z));
    const double u = std::abs(polarAngle(p.x, p.y, p.z)) / kCoarseAngle, v = (p.z - kBottom) / kCoarseStep;
    const int i = std::clamp(int(u), 0, kCoarseAngles - 2), j = std::clamp(int(v), 0, kCoarseLevels - 2);
    const double s = u - i, t = v - j;
    const int nodes[] = {node(i, j), node(i + 1, j), node(i, j + 1), node(i + 1, j + 1)};
    const double factors[] = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
    addRow(nodes, factors, 4, radius, sample.weight);
  }

  // Second differences along both directions; across the sagittal plane the surface is its own mirror image.
  for (int j = 0; j < kCoarseLevels; ++j)
    for (int i = 0; i < kCoarseAngles; ++i) {
      const double factors[] = {1, -2, 1};
      const int around[] = {node(mirrored(i - 1, kCoarseAngles), j), node(i, j),
                            node(mirrored(i + 1, kCoarseAngles), j)};
      addRow(around, factors, 3, 0, kSmoothness);
      if (j == 0 || j == kCoarseLevels - 1) continue;
      const int along[] = {node(i, j - 1), node(i, j), node(i, j + 1)};
      addRow(along, factors, 3, 0, kSmoothness);
    }
  Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::VectorXd coarse = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);

  // Bicubic to the fine table.
  return of([&](double a, double z) {
    const double u = std::abs(a) / kCoarseAngle, v = (z - kBottom) / kCoarseStep;
    const int i = std::min(int(u), kCoarseAngles - 2), j = std::min(int(v), kCoarseLevels - 2);
    double rows[4];
    for (int k = 0; k < 4; ++k) {
      const int row = std::clamp(j - 1 + k, 0, kCoarseLevels - 1);
      const auto get = [&](int column) { return coarse[node(mirrored(column, kCoarseAngles), row)]; };
      rows[k] = cubic(get(i - 1), get(i), get(i + 1), get(i + 2), u - i);
    }
    return cubic(rows[0], rows[1], rows[2], rows[3], v - j);
  });
}

double PolarTable::radius(double a, double z) const {
  const double u = a * 180 / kPi + 180, v = std::clamp((z - kBottom) / kStep, 0.0, double(levels() - 1));
  const int i = int(std::floor(u)), j = std::min(int(v), levels() - 2);
  const double s = u - i, t = v - j;
  return (value(i, j) * (1 - s) + value(i + 1, j) * s) * (1 - t) +
         (value(i, j + 1) * (1 - s) + value(i + 1, j + 1) * s) * t;
}

Vec3 PolarTable::at(double a, double z) const {
  const double r = radius(a, z);
  return {r * std::sin(a), polarCenterY(z) - r * std::cos(a), z};
}

std::vector<float> PolarTable::levelRadii(double z) const {
  std::vector<float> radii(kAngles + 1);
  for (int i = 0; i <= kAngles; ++i) radii[i] = float(radius(angle(i), z));
  return radii;
}

double PolarTable::normalFactor(double a, double z) const {
  // Gradient of r(x, y, z) - R(angle, z); the centre's drift along z enters through dr/dz and d(angle)/dz.
  const double r = radius(a, z), da = radians(1);
  const double byAngle = (radius(a + da, z) - radius(a - da, z)) / (2 * da);
  const double byZ = (radius(a, z + kStep) - radius(a, z - kStep)) / (2 * kStep);
  const double drift = (polarCenterY(z + 1) - polarCenterY(z - 1)) / 2;
  const double alongZ = std::cos(a) * drift - byZ + byAngle * std::sin(a) * drift / r;
  return 1 / std::sqrt(1 + byAngle * byAngle / (r * r) + alongZ * alongZ);
}

std::vector<float> PolarTable::levelNormalFactors(double z) const {
  std::vector<float> factors(kAngles + 1);
  for (int i = 0; i <= kAngles; ++i) factors[i] = float(normalFactor(angle(i), z));
  return factors;
}

void PolarTable::smooth(int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    PolarTable old = *this;
    for (int j = 0; j < levels(); ++j)
      for (int i = 0; i < kAngles; ++i) value(i, j) = (old.value(i - 1, j) + 2 * old.value(i, j) + old.value(i + 1, j)) / 4;
    old = *this;
    for (int j = 1; j + 1 < levels(); ++j)
      for (int i = 0; i < kAngles; ++i) value(i, j) = (old.value(i, j - 1) + 2 * old.value(i, j) + old.value(i, j + 1)) / 4;
  }
}

}  // namespace pectora::phantom
