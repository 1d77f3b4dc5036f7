#include "plugins/register/icp/normal_equations.h"

#include <cmath>
#include <limits>

namespace pectora {

Vector6 NormalEquations::row(Vec3 p, Vec3 n) const {
  const Vec3 turn = cross(p - center, n) / radius;
  Vector6 j;
  j << turn.x, turn.y, turn.z, n.x, n.y, n.z;
  return j;
}

void NormalEquations::add(Vec3 p, Vec3 n, double residual, double weight) {
  const Vector6 j = row(p, n);
  // The upper triangle is enough.
  for (int c = 0; c < 6; ++c)
    for (int r = 0; r <= c; ++r) matrix(r, c) += weight * j(r) * j(c);
  right += weight * residual * j;
  squares += residual * residual;
  ++count;
}

void NormalEquations::add(const NormalEquations& other) {
  matrix += other.matrix;
  right += other.right;
  squares += other.squares;
  count += other.count;
}

AffineMap rigidStep(const NormalEquations& equations, const Vector6& step) {
  const Eigen::Vector3d turn = step.head<3>() / equations.radius;
  const double angle = turn.norm();
  const Eigen::Matrix3d rotation = angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  AffineMap map;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) map.linear[r][c] = rotation(r, c);
  map.translation = equations.center - map.rotate(equations.center) + Vec3{step(3), step(4), step(5)};
  return map;
}

AffineMap compose(const AffineMap& second, const AffineMap& first) {
  AffineMap map;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      map.linear[r][c] = 0;
      for (int k = 0; k < 3; ++k) map.linear[r][c] += second.linear[r][k] * first.linear[k][c];
    }
  map.translation = second(first.translation);
  return map;
}

Solved solve(const NormalEquations& equations) {
  const Matrix6 full = equations.matrix.selfadjointView<Eigen::Upper>();
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(full);
  const Vector6 values = eigen.eigenvalues();
  Solved solved;
  solved.weakest = eigen.eigenvectors().col(0);
  solved.condition = values(0) > 0 ? std::sqrt(values(5) / values(0)) : std::numeric_limits<double>::infinity();
  solved.inverse.setZero();
  for (int i = 0; i < 6; ++i) {
    if (!(values(i) > 1e-6 * values(5))) {
      ++solved.undetermined;
      continue;
    }
    const Vector6 direction = eigen.eigenvectors().col(i);
    solved.inverse += direction * direction.transpose() / values(i);
  }
  solved.step = -(solved.inverse * equations.right);
  return solved;
}

}  // namespace pectora
