// The second derivative of an energy, as solvers use it: products with a vector, and its 3 x 3 blocks on the diagonal.
#pragma once

#include "kernel/physics/system.h"

namespace pectora {

/// A symmetric 3 x 3 matrix.
struct Symmetric3 {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  Symmetric3& operator+=(const Symmetric3& b) {
    xx += b.xx, xy += b.xy, xz += b.xz, yy += b.yy, yz += b.yz, zz += b.zz;
    return *this;
  }
  Symmetric3 operator-() const { return {-xx, -xy, -xz, -yy, -yz, -zz}; }
  /// Adds s times the identity.
  void addIdentity(double s) { xx += s, yy += s, zz += s; }
  Vec3 operator*(Vec3 v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
};
/// The inverse of a positive definite matrix. A direction in which it is not positive counts as weak, not as endless:
/// the diagonal is raised until all pivots exceed 1e-9 of the trace. Of a matrix without positive trace: the identity.
Symmetric3 inverse(Symmetric3 a);

/// A 3 x 3 matrix, by rows.
struct Matrix3 {
  double m[3][3] = {};
};

/// A term's second derivative at one place. Each call of linearise moves it to another.
class Hessian {
 public:
  virtual ~Hessian() = default;
  /// Takes the derivative at `positions` (all nodes); `projected`: its nearest positive semi-definite form, element by element.
  /// An element that has no direction of its own (a spring of no length) is always projected.
  virtual void linearise(const NodeVectors& positions, bool projected) = 0;
  /// y += H v, with v over all nodes; y of driven nodes means nothing. The result does not depend on the number of threads.
  virtual void multiply(const NodeVectors& v, NodeVectors& y) const = 0;
  /// y += H v in single precision. `v` and `y` end with the grid of layers; anchors, which lie beyond, stand still.
  /// Unless a term does better, by multiply: right for all but those that reach the anchors.
  virtual void multiplySingle(const SingleVectors& v, SingleVectors& y) const;
  /// Adds the blocks on the diagonal, one a node, N/mm.
  virtual void addDiagonal(std::vector<Symmetric3>& blocks) const = 0;
  /// Calls visit(a, b, block) for the blocks beside the diagonal, N/mm: the one that joins the forces on node a with the
  /// movement of node b. Of (a, b) and (b, a), which are each other's transpose, only one is shown; a pair may be shown in
  /// several parts. The order is always the same.
  using Coupling = std::function<void(std::size_t a, std::size_t b, const Matrix3& block)>;
  virtual void forEachCoupling(const Coupling& visit) const = 0;
  /// The same, faster where many blocks join nodes that lie side by side: run(a, b, count, entries) shows those of (a + i, b + i) for i below
  /// count, entry (j, k) of them at entries[3 j + k][i]. Runs may come from several threads at once, but then their rows of the grid lie
  /// so far apart that two rows between them belong to neither. What makes no runs is shown to `visit`.
  using CouplingRun = std::function<void(std::size_t a, std::size_t b, std::size_t count, const float* const entries[9])>;
  virtual void forEachCouplingRun(const CouplingRun& /*run*/, const Coupling& visit) const { forEachCoupling(visit); }
};

/// The Hessian of all terms of a system; null if a term has none.
std::unique_ptr<Hessian> makeHessian(const System& system);

}  // namespace pectora
