#include "plugins/splines/cartilage/fit.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace pectora {

Curve fitCurve(std::span<const Vec3> points, int controls) {
  const int count = int(points.size());
  Curve curve;
  controls = std::clamp(controls, 4, std::max(4, count));
  curve.knots = clampedKnots(controls, 3);
  curve.controls.assign(controls, points.front());
  curve.controls.back() = points.back();

  // Chord-length parameters.
  std::vector<double> u(count, 0.0);
  for (int i = 1; i < count; ++i) u[i] = u[i - 1] + distance(points[i - 1], points[i]);
  if (u.back() <= 0) return curve;
  for (double& x : u) x /= u.back();

  // Normal equations for the inner control points, with a slight pull to evenness where points are few.
  const int inner = controls - 2;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(inner, inner);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(inner, 3);
  const auto addRow = [&](const std::vector<std::pair<int, double>>& row, Vec3 value, double weight) {
    for (const auto& [j, w] : row)
      if (j == 0 || j == controls - 1) value -= curve.controls[j] * w;
    for (const auto& [j, w] : row) {
      if (j == 0 || j == controls - 1) continue;
      for (const auto& [k, v] : row)
        if (k != 0 && k != controls - 1) normal(j - 1, k - 1) += weight * w * v;
      right.row(j - 1) += weight * w * Eigen::RowVector3d(value.x, value.y, value.z);
    }
  };
  for (int i = 0; i < count; ++i) {
    const BasisWeights b = basis(curve.knots, 3, u[i]);
    std::vector<std::pair<int, double>> row;
    for (int k = 0; k <= 3; ++k) row.emplace_back(b.first + k, b.weights[k]);
    addRow(row, points[i], 1);
  }
  for (int j = 1; j + 1 < controls; ++j) addRow({{j - 1, 1}, {j, -2}, {j + 1, 1}}, {}, 1e-6 * count);
  const Eigen::MatrixXd solved = normal.ldlt().solve(right);
  for (int j = 0; j < inner; ++j) curve.controls[j + 1] = {solved(j, 0), solved(j, 1), solved(j, 2)};
  return curve;
}

double rmsDistance(const Curve& curve, std::span<const Vec3> points) {
  double sum = 0;
  for (const Vec3& p : points) {
    const double d = distance(p, curve.at(curve.closest(p)));
    sum += d * d;
  }
  return points.empty() ? 0 : std::sqrt(sum / double(points.size()));
}

Curve hermiteCurve(Vec3 a, Vec3 tangentA, Vec3 b, Vec3 tangentB, double handleA, double handleB) {
  const double far = distance(a, b);
  return {3, clampedKnots(4, 3), {a, a + tangentA * (handleA * far), b - tangentB * (handleB * far), b}};
}

}  // namespace pectora
