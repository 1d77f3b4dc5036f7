// Singular values of 3 x 3 matrices, one in every lane of a pack.
#pragma once

#include "plugins/effect/common/cell_pack.h"

#include <utility>

namespace pectora::cells {

PECTORA_INLINE Pack root(const Pack& a) {
  double values[kLanes];
  std::memcpy(values, &a, sizeof a);
  for (int lane = 0; lane < kLanes; ++lane) values[lane] = __builtin_sqrt(values[lane]);
  Pack r;
  std::memcpy(&r, values, sizeof r);
  return r;
}

/// Brings a symmetric matrix to its diagonal: A = E diag E^T. Five cyclic sweeps of Jacobi's rotations, of which three already
/// reach machine precision for almost every matrix of this size.
PECTORA_INLINE void diagonalise(Pack (&a)[3][3], Pack (&e)[3][3]) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) e[i][j] = Pack{} + (i == j ? 1.0 : 0.0);
  for (int sweep = 0; sweep < 5; ++sweep)
    for (int r = 0; r < 3; ++r) {
      const int p = r == 2 ? 1 : 0, q = r == 0 ? 1 : 2, o = 3 - p - q;
      const Pack off = a[p][q], apart = a[q][q] - a[p][p];
      // tan of the angle: 2 off / (apart +- sqrt(apart^2 + 4 off^2)), 0 where there is nothing to turn.
      const Pack radius = root(apart * apart + 4 * off * off);
      const Pack below = apart < 0 ? apart - radius : apart + radius;
      const Pack t = below == 0 ? Pack{} : 2 * off / (below == 0 ? Pack{} + 1 : below);
      const Pack c = 1 / root(1 + t * t), s = t * c;
      a[p][p] -= t * off, a[q][q] += t * off;
      a[p][q] = a[q][p] = Pack{};
      const Pack op = a[o][p], oq = a[o][q];
      a[o][p] = a[p][o] = c * op - s * oq;
      a[o][q] = a[q][o] = s * op + c * oq;
      for (int i = 0; i < 3; ++i) {
        const Pack ep = e[i][p], eq = e[i][q];
        e[i][p] = c * ep - s * eq;
        e[i][q] = s * ep + c * eq;
      }
    }
}

/// F = U diag(s) V^T with rotations U and V: s[0] >= s[1] >= |s[2]|, and s[2] has the sign of det F.
PECTORA_INLINE void decompose(const Pack (&f)[3][3], Pack (&u)[3][3], Pack (&s)[3], Pack (&v)[3][3]) {
  Pack a[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) a[i][j] = f[0][i] * f[0][j] + f[1][i] * f[1][j] + f[2][i] * f[2][j];
  diagonalise(a, v);
  // Largest first. A column that changes places changes its sign, so that V stays a rotation.
  for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {0, 1}}) {
    const Mask swap = a[i][i] < a[j][j];
    const Pack x = a[i][i], y = a[j][j];
    a[i][i] = swap ? y : x, a[j][j] = swap ? x : y;
    for (int k = 0; k < 3; ++k) {
      const Pack p = v[k][i], q = v[k][j];
      v[k][i] = swap ? q : p, v[k][j] = swap ? -p : q;
    }
  }
  // Columns of F V: the first gives u0, the second what is left across it, the third lies across both.
  Pack b[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) b[i][j] = f[i][0] * v[0][j] + f[i][1] * v[1][j] + f[i][2] * v[2][j];
  s[0] = root(b[0][0] * b[0][0] + b[1][0] * b[1][0] + b[2][0] * b[2][0]);
  const Mask none = s[0] == 0;
  for (int i = 0; i < 3; ++i) u[i][0] = none ? Pack{} + (i == 0 ? 1.0 : 0.0) : b[i][0] / (none ? Pack{} + 1 : s[0]);
  const Pack along = u[0][0] * b[0][1] + u[1][0] * b[1][1] + u[2][0] * b[2][1];
  Pack rest[3];
  for (int i = 0; i < 3; ++i) rest[i] = b[i][1] - along * u[i][0];
  s[1] = root(rest[0] * rest[0] + rest[1] * rest[1] + rest[2] * rest[2]);
  // Of a matrix of rank one any vector across u0 will do.
  const Mask flat = s[1] <= 1e-14 * s[0];
  const Mask steep = u[0][0] * u[0][0] > 0.5;
  const Pack other[3] = {steep ? -u[1][0] : Pack{}, steep ? u[0][0] : u[2][0], steep ? Pack{} : -u[1][0]};
  for (int i = 0; i < 3; ++i) rest[i] = flat ? other[i] : rest[i];
  const Pack length = root(rest[0] * rest[0] + rest[1] * rest[1] + rest[2] * rest[2]);
  for (int i = 0; i < 3; ++i) u[i][1] = rest[i] / length;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    u[i][2] = u[i1][0] * u[i2][1] - u[i2][0] * u[i1][1];
  }
  s[2] = u[0][2] * b[0][2] + u[1][2] * b[1][2] + u[2][2] * b[2][2];
}

}  // namespace pectora::cells
