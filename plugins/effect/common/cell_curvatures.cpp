#include "plugins/effect/common/cell_curvatures.h"

#include "plugins/effect/common/pack_svd.h"

#include <cmath>

namespace pectora::cells {
namespace {

// Derivatives of the shape functions at the points of quadrature along the cell's directions, and what follows from them.
struct Shapes {
  double gradient[kPoints][kCorners][3];
  constexpr Shapes() : gradient() {
    for (int q = 0; q < kPoints; ++q)
      for (int a = 0; a < kCorners; ++a)
        for (int j = 0; j < 3; ++j) {
          double product = 1;
          for (int k = 0; k < 3; ++k) {
            const double place = kPlace[q >> k & 1];
            const bool isFar = a >> k & 1;
            product *= k == j ? (isFar ? 1 : -1) : (isFar ? place : 1 - place);
          }
          gradient[q][a][j] = product;
        }
  }
};
constexpr Shapes kShapes;

// Which pair of corners a <= b a block belongs to.
constexpr int kPairs = kCorners * (kCorners + 1) / 2;
constexpr int pairOf(int a, int b) { return a * kCorners - a * (a - 1) / 2 + b - a; }

// The blocks between the corners of the cells. A block of a corner with itself uses its upper half.
struct Blocks {
  Pack k[kPairs][3][3];
};

// g[a] = m grad N_a.
PECTORA_INLINE void atCorners(const Pack (&m)[3][3], int q, Pack (&g)[kCorners][3]) {
  for (int a = 0; a < kCorners; ++a)
    for (int i = 0; i < 3; ++i)
      g[a][i] = m[i][0] * kShapes.gradient[q][a][0] + m[i][1] * kShapes.gradient[q][a][1] + m[i][2] * kShapes.gradient[q][a][2];
}

// blocks += s g g^T.
PECTORA_INLINE void addOuter(const Pack& s, const Pack (&g)[kCorners][3], Blocks& blocks) {
  for (int a = 0; a < kCorners; ++a)
    for (int i = 0; i < 3; ++i) {
      const Pack scaled = s * g[a][i];
      for (int b = a; b < kCorners; ++b)
        for (int k = 0; k < 3; ++k) blocks.k[pairOf(a, b)][i][k] += scaled * g[b][k];
    }
}

// c = a b^T.
PECTORA_INLINE void timesTransposed(const Pack (&a)[3][3], const Pack (&b)[3][3], Pack (&c)[3][3]) {
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) c[i][k] = a[i][0] * b[k][0] + a[i][1] * b[k][1] + a[i][2] * b[k][2];
}

PECTORA_INLINE bool isAnyPositive(const Pack& p) {
  bool any = false;
  for (int lane = 0; lane < kLanes; ++lane) any |= p[lane] > 0;
  return any;
}

// What is missing to make mu I + c H_J + volumetric cof F cof F^T semi-definite, H_J the second derivative of J. With F = U S V^T
// its eigenmatrices are (science: Smith, de Goes and Kim 2018) the three U (e_i e_j^T +- e_j e_i^T) V^T, with mu -+ c s_k, and
// three U diag(e) V^T, with e of the matrix mu I + c [0 s3 s2; s3 0 s1; s2 s1 0] + volumetric t t^T, t = (s2 s3, s3 s1, s1 s2).
PECTORA_INLINE void addMissing(const Pack (&f)[3][3], const Pack& mu, const Pack& c, const Pack& volumetric, const Pack& weight,
                               const Pack (&inverse)[3][3], int q, Blocks& blocks) {
  Pack u[3][3], v[3][3], s[3];
  decompose(f, u, s, v);
  // What V's columns are along the cell's directions.
  Pack m[3][3], w[3][3], g[kCorners][3];
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) w[j][i] = inverse[j][0] * v[0][i] + inverse[j][1] * v[1][i] + inverse[j][2] * v[2][i];
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Pack turned = c * s[k], size = turned < 0 ? -turned : turned, lack = size > mu ? size - mu : Pack{};
    if (!isAnyPositive(lack)) continue;
    const Pack sign = turned > 0 ? Pack{} + 1 : Pack{} - 1;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) m[a][b] = u[a][i] * w[b][j] + sign * u[a][j] * w[b][i];
    atCorners(m, q, g);
    addOuter(0.5 * weight * lack, g, blocks);
  }
  const Pack t[3] = {s[1] * s[2], s[2] * s[0], s[0] * s[1]};
  Pack a[3][3], e[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) a[i][j] = volumetric * t[i] * t[j] + (i == j ? mu : c * s[3 - i - j]);
  diagonalise(a, e);
  for (int n = 0; n < 3; ++n) {
    const Pack lack = a[n][n] < 0 ? -a[n][n] : Pack{};
    if (!isAnyPositive(lack)) continue;
    for (int x = 0; x < 3; ++x)
      for (int y = 0; y < 3; ++y) m[x][y] = u[x][0] * e[0][n] * w[y][0] + u[x][1] * e[1][n] * w[y][1] + u[x][2] * e[2][n] * w[y][2];
    atCorners(m, q, g);
    addOuter(weight * lack, g, blocks);
  }
}

}  // namespace

PECTORA_WIDE void addCurvatures(const Run& run, const RestPack& rest, bool projected, float* const (&rows)[4], std::size_t stride) {
  Deformation s;
  deform(run, rest, s);
  Blocks blocks;
  std::memset(&blocks, 0, sizeof blocks);
  Pack meanGradient[kCorners][3] = {};
  const Pack volumetric = (1.0 / 3) * rest.shear;
  for (int q = 0; q < kPoints; ++q) {
    const Pack c = volumetric * s.grown[q] - rest.shear + rest.bulk * s.meanGrown;
    Pack f[3][3];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) f[i][k] = s.displacement[q][i][k] + (i == k ? 1.0 : 0.0);
    const Pack weight = rest.weight[q];
    Pack m[3][3], g[kCorners][3];
    // mu I: the same for all three directions.
    timesTransposed(rest.inverse[q], rest.inverse[q], m);
    atCorners(m, q, g);
    const Pack stiffness = weight * rest.shear;
    for (int a = 0; a < kCorners; ++a)
      for (int b = a; b < kCorners; ++b) {
        const double* n = kShapes.gradient[q][b];
        const Pack along = stiffness * (g[a][0] * n[0] + g[a][1] * n[1] + g[a][2] * n[2]);
        for (int i = 0; i < 3; ++i) blocks.k[pairOf(a, b)][i][i] += along;
      }
    // c H_J: between corners a and b the matrix t -> [0 t2 -t1; -t2 0 t0; t1 -t0 0] with t = c F (grad N_a x grad N_b).
    Pack turned[3][3], transposed[3][3];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) transposed[i][k] = rest.inverse[q][k][i];
    cofactors(transposed, turned);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        m[i][k] = weight * c * (f[i][0] * turned[0][k] + f[i][1] * turned[1][k] + f[i][2] * turned[2][k]);
    for (int a = 0; a < kCorners; ++a)
      for (int b = a + 1; b < kCorners; ++b) {
        const double *p = kShapes.gradient[q][a], *n = kShapes.gradient[q][b];
        const double x = p[1] * n[2] - p[2] * n[1], y = p[2] * n[0] - p[0] * n[2], z = p[0] * n[1] - p[1] * n[0];
        Pack(&k)[3][3] = blocks.k[pairOf(a, b)];
        const Pack t0 = m[0][0] * x + m[0][1] * y + m[0][2] * z, t1 = m[1][0] * x + m[1][1] * y + m[1][2] * z,
                   t2 = m[2][0] * x + m[2][1] * y + m[2][2] * z;
        k[0][1] += t2, k[1][0] -= t2, k[1][2] += t0, k[2][1] -= t0, k[2][0] += t1, k[0][2] -= t1;
      }
    // mu/3 cof F cof F^T, and the gradient of the cell's volume.
    timesTransposed(s.cofactor[q], rest.inverse[q], m);
    atCorners(m, q, g);
    addOuter(weight * volumetric, g, blocks);
    for (int a = 0; a < kCorners; ++a)
      for (int i = 0; i < 3; ++i) meanGradient[a][i] += weight * g[a][i];
    if (projected) addMissing(f, rest.shear, c, volumetric, weight, rest.inverse[q], q, blocks);
  }
  addOuter(rest.bulk * rest.inverseVolume, meanGradient, blocks);

  for (int a = 0; a < kCorners; ++a)
    for (int b = a; b < kCorners; ++b) {
      const int step[3] = {(b >> 2) - (a >> 2), (b >> 1 & 1) - (a >> 1 & 1), (b & 1) - (a & 1)};
      // Neighbours in order: their number follows from the steps.
      const int neighbour = 9 * step[0] + 3 * step[1] + step[2] - 1;
      float* first = rows[a >> 1] + (a & 1);
      int entry = a == b ? 0 : 6 + 9 * neighbour;
      for (int i = 0; i < 3; ++i)
        for (int k = a == b ? i : 0; k < 3; ++k, ++entry) {
          float* target = first + entry * stride;
          const Pack& value = blocks.k[pairOf(a, b)][i][k];
          for (int lane = 0; lane < run.count; ++lane) target[lane] += float(value[lane]);
        }
    }
}

PECTORA_WIDE void blockProducts(std::size_t count, const float* entries, std::size_t stride, ConstRow<double> near, ConstRow<double> far, Row<double> sum, Row<double> farSum) {
  const float* k[9];
  for (int e = 0; e < 9; ++e) k[e] = entries + e * stride;
  const double *nx = near.x, *ny = near.y, *nz = near.z, *fx = far.x, *fy = far.y, *fz = far.z;
  double *sx = sum.x, *sy = sum.y, *sz = sum.z, *tx = farSum.x, *ty = farSum.y, *tz = farSum.z;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const double k00 = double(k[0][i]), k01 = double(k[1][i]), k02 = double(k[2][i]), k10 = double(k[3][i]), k11 = double(k[4][i]),
                 k12 = double(k[5][i]), k20 = double(k[6][i]), k21 = double(k[7][i]), k22 = double(k[8][i]);
    sx[i] += k00 * fx[i] + k01 * fy[i] + k02 * fz[i];
    sy[i] += k10 * fx[i] + k11 * fy[i] + k12 * fz[i];
    sz[i] += k20 * fx[i] + k21 * fy[i] + k22 * fz[i];
    tx[i] += k00 * nx[i] + k10 * ny[i] + k20 * nz[i];
    ty[i] += k01 * nx[i] + k11 * ny[i] + k21 * nz[i];
    tz[i] += k02 * nx[i] + k12 * ny[i] + k22 * nz[i];
  }
}

PECTORA_WIDE void diagonalProducts(std::size_t count, const float* entries, std::size_t stride, ConstRow<double> v, Row<double> sum) {
  const float *xx = entries, *xy = xx + stride, *xz = xy + stride, *yy = xz + stride, *yz = yy + stride, *zz = yz + stride;
  const double *x = v.x, *y = v.y, *z = v.z;
  double *sx = sum.x, *sy = sum.y, *sz = sum.z;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    sx[i] += double(xx[i]) * x[i] + double(xy[i]) * y[i] + double(xz[i]) * z[i];
    sy[i] += double(xy[i]) * x[i] + double(yy[i]) * y[i] + double(yz[i]) * z[i];
    sz[i] += double(xz[i]) * x[i] + double(yz[i]) * y[i] + double(zz[i]) * z[i];
  }
}

}  // namespace pectora::cells
