// Several cells side by side in the lanes of a register, and the interpolation within them. Every lane does the same
// arithmetic, so its bits are the same for every instruction set.
#pragma once

#include "kernel/physics/rows.h"

#include <cstddef>
#include <cstdint>
#include <cstring>

// A pack wider than the machine's registers is split by the compiler, and never crosses the border of a library.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace pectora::cells {

inline constexpr int kLanes = 8;
typedef double Pack __attribute__((vector_size(kLanes * sizeof(double))));
typedef std::int64_t Mask __attribute__((vector_size(kLanes * sizeof(double))));

/// Corners of a cell and points of quadrature are numbered by bits: 1 along the columns, 2 along the rows, 4 through the layers.
inline constexpr int kCorners = 8, kPoints = 8;
/// Where the points of quadrature lie in a direction, 0 to 1: (1 -+ 1/sqrt 3) / 2.
inline constexpr double kPlace[2] = {0.21132486540518711775, 0.78867513459481288225};

/// The rest state of a pack of cells, aligned for the widest registers; lanes beyond the last cell of a row are all zero.
struct alignas(sizeof(Pack)) RestPack {
  Pack inverse[kPoints][3][3];   ///< d xi_j / d X_k, 1/mm
  Pack weight[kPoints];          ///< volume that a point stands for, mm^3
  Pack inverseVolume;            ///< of the cell, 1/mm^3
  Pack shear, bulk;              ///< MPa
};

/// Numbers of the nodes at the corners of a pack: by coordinate and row, which is layer bit * 2 + row bit.
struct CornerRows {
  const double* rows[3][4];
};
/// A pack of cells in the grid: `count` of them, along the columns.
struct Run {
  int count;
  CornerRows positions, rest;
};

/// The coordinate `axis` of all corners. Lanes beyond the last cell repeat it.
PECTORA_INLINE void load(const CornerRows& corners, int count, int axis, Pack (&v)[kCorners]) {
  for (int a = 0; a < kCorners; ++a) {
    const double* first = corners.rows[axis][a >> 1] + (a & 1);
    if (count == kLanes) {
      std::memcpy(&v[a], first, sizeof(Pack));
    } else {
      for (int lane = 0; lane < kLanes; ++lane) v[a][lane] = first[lane < count ? lane : count - 1];
    }
  }
}

/// Index of a point of quadrature among the four over which the derivative along direction `d` varies.
constexpr int across(int d, int q) { return d == 0 ? q >> 1 : d == 1 ? (q & 1) | (q >> 1 & 2) : q & 3; }
/// The corner with bit `d` set or not whose other two bits are those of `i`.
constexpr int corner(int d, int bit, int i) {
  return d == 0 ? i << 1 | bit : d == 1 ? (i & 1) | bit << 1 | (i & 2) << 1 : i | bit << 2;
}

/// Derivatives of a trilinear function along the three directions at the points of quadrature: d[direction][across].
PECTORA_INLINE void derivatives(const Pack (&v)[kCorners], Pack (&d)[3][4]) {
  for (int k = 0; k < 3; ++k) {
    Pack edge[4], half[4];
    for (int i = 0; i < 4; ++i) edge[i] = v[corner(k, 1, i)] - v[corner(k, 0, i)];
    for (int i = 0; i < 4; ++i) half[i] = edge[i & 2] * (1 - kPlace[i & 1]) + edge[i | 1] * kPlace[i & 1];
    for (int i = 0; i < 4; ++i) d[k][i] = half[i & 1] * (1 - kPlace[i >> 1]) + half[i | 2] * kPlace[i >> 1];
  }
}

/// Its transpose: v += what the sums `d` mean for the corners.
PECTORA_INLINE void addTransposed(const Pack (&d)[3][4], Pack (&v)[kCorners]) {
  for (int k = 0; k < 3; ++k) {
    Pack half[4], edge[4];
    const double weight[2][2] = {{1 - kPlace[0], 1 - kPlace[1]}, {kPlace[0], kPlace[1]}};   // of an end, by point
    for (int i = 0; i < 4; ++i) half[i] = d[k][i & 1] * weight[i >> 1][0] + d[k][i | 2] * weight[i >> 1][1];
    for (int i = 0; i < 4; ++i) edge[i] = half[i & 2] * weight[i & 1][0] + half[i | 1] * weight[i & 1][1];
    for (int i = 0; i < 4; ++i) v[corner(k, 1, i)] += edge[i], v[corner(k, 0, i)] -= edge[i];
  }
}

/// The cofactors of a matrix: cof F = d det F / d F.
PECTORA_INLINE void cofactors(const Pack (&f)[3][3], Pack (&c)[3][3]) {
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      c[i][k] = f[i1][k1] * f[i2][k2] - f[i1][k2] * f[i2][k1];
    }
}
PECTORA_INLINE Pack determinant(const Pack (&f)[3][3], const Pack (&c)[3][3]) {
  return f[0][0] * c[0][0] + f[0][1] * c[0][1] + f[0][2] * c[0][2];
}

/// The deformation of a pack's cells at all points of quadrature. Everything follows from the gradient of the displacements,
/// so that small strains lose no digits.
struct Deformation {
  Pack displacement[kPoints][3][3];   ///< H = F - 1
  Pack small[kPoints];                ///< tr cof H + det H = J - 1 - tr H
  Pack grown[kPoints];                ///< J - 1
  Pack cofactor[kPoints][3][3];       ///< cof F = (1 + tr H) 1 - H^T + cof H
  Pack meanGrown;                     ///< mean of J - 1 over the cell
};

PECTORA_INLINE void deform(const Run& run, const RestPack& rest, Deformation& s) {
  Pack d[3][3][4];
  for (int i = 0; i < 3; ++i) {
    Pack v[kCorners], from[kCorners];
    load(run.positions, run.count, i, v);
    load(run.rest, run.count, i, from);
    for (int a = 0; a < kCorners; ++a) v[a] -= from[a];
    derivatives(v, d[i]);
  }
  s.meanGrown = Pack{};
  for (int q = 0; q < kPoints; ++q) {
    Pack(&h)[3][3] = s.displacement[q];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        h[i][k] = d[i][0][across(0, q)] * rest.inverse[q][0][k] + d[i][1][across(1, q)] * rest.inverse[q][1][k] +
                  d[i][2][across(2, q)] * rest.inverse[q][2][k];
    Pack c[3][3];
    cofactors(h, c);
    const Pack trace = h[0][0] + h[1][1] + h[2][2];
    s.small[q] = (c[0][0] + c[1][1] + c[2][2]) + determinant(h, c);
    s.grown[q] = trace + s.small[q];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) s.cofactor[q][i][k] = c[i][k] - h[k][i] + (i == k ? 1 + trace : Pack{});
    s.meanGrown += rest.weight[q] * s.grown[q];
  }
  s.meanGrown *= rest.inverseVolume;
}

}  // namespace pectora::cells
