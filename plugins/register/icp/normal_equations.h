// One step of point-to-plane alignment: weighted residuals, the six unknowns, and how well they are determined.
#pragma once

#include "kernel/value/comparison.h"

#include <Eigen/Dense>

namespace pectora {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Sums of J^T w J and J^T w r over residuals r + J (turn, shift), turn about `center` in units of `radius` (so that all six unknowns
/// are mm: a turn of 1 moves a point at `radius` by 1 mm).
struct NormalEquations {
  Vec3 center;
  double radius = 1;
  Matrix6 matrix = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  double squares = 0;       ///< sum of r^2
  std::size_t count = 0;    ///< number of residuals

  /// How the distance of a point at p along the unit direction n changes with the unknowns.
  Vector6 row(Vec3 p, Vec3 n) const;
  void add(Vec3 p, Vec3 n, double residual, double weight);
  void add(const NormalEquations& other);
};

/// A small turn and shift as a rigid map: the exact rotation by the turn about the equations' centre, then the shift.
AffineMap rigidStep(const NormalEquations& equations, const Vector6& step);
/// The map that does `first`, then `second`.
AffineMap compose(const AffineMap& second, const AffineMap& first);

/// The solution and what it hangs on. Directions that the residuals say nothing of (known a thousand times worse than the best) stay put.
struct Solved {
  Vector6 step = Vector6::Zero();
  int undetermined = 0;        ///< directions that stayed put
  double condition = 1;        ///< square root of largest over smallest eigenvalue: how many times worse the weakest direction is known
  Vector6 weakest;             ///< unit direction of the smallest eigenvalue
  Matrix6 inverse;             ///< without the undetermined directions
};
Solved solve(const NormalEquations& equations);

}  // namespace pectora
