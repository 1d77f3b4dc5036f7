#include "kernel/physics/lattice_rows.h"

#include <cmath>

namespace pectora::lattice {
namespace {

// Where the far end of a spring lies from the near one, and a and b of its second derivative there.
struct Curvature {
  float dx, dy, dz, a, b;
  bool isDegenerate;
};

// From what the far end has moved against the near one (ux, uy, uz) and where it lay at rest.
PECTORA_INLINE Curvature curvatureOf(float ux, float uy, float uz, float dx0, float dy0, float dz0, float stretched, float compressed, float floor) {
  const float dx = dx0 + ux, dy = dy0 + uy, dz = dz0 + uz;
  const float squared = dx * dx + dy * dy + dz * dz, squared0 = dx0 * dx0 + dy0 * dy0 + dz0 * dz0;
  const bool isDegenerate = squared <= kDegenerateSingle * kDegenerateSingle * squared0;
  const float safe = isDegenerate ? 1.0f : squared;
  // l^2 - l0^2, without loss of digits.
  const float growth = ux * (dx + dx0) + uy * (dy + dy0) + uz * (dz + dz0);
  const float k = isDegenerate ? 0.0f : growth < 0 ? compressed : stretched;
  const float across = k * growth / (safe + std::sqrt(safe * squared0));
  const float a = across < floor ? floor : across;
  return {dx, dy, dz, a, (k - a) / safe, isDegenerate};
}

}  // namespace

PECTORA_WIDE void springForces(const RowSprings<double>& springs, Row<double> gradient, Row<double> pull, RowSums sums) {
  const double *nx = springs.near.x, *ny = springs.near.y, *nz = springs.near.z;
  const double *fx = springs.far.x, *fy = springs.far.y, *fz = springs.far.z;
  const double *nx0 = springs.restNear.x, *ny0 = springs.restNear.y, *nz0 = springs.restNear.z;
  const double *fx0 = springs.restFar.x, *fy0 = springs.restFar.y, *fz0 = springs.restFar.z;
  double *gx = gradient.x, *gy = gradient.y, *gz = gradient.z, *px = pull.x, *py = pull.y, *pz = pull.z;
  double *energy = sums.twiceEnergy, *largest = sums.largest, *degenerate = sums.degenerate;
  const double stretched = springs.stiffness, compressed = springs.stiffness * springs.compression;
  const std::size_t count = springs.count;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const double dx = fx[i] - nx[i], dy = fy[i] - ny[i], dz = fz[i] - nz[i];
    const double dx0 = fx0[i] - nx0[i], dy0 = fy0[i] - ny0[i], dz0 = fz0[i] - nz0[i];
    const double l = std::sqrt(dx * dx + dy * dy + dz * dz), l0 = std::sqrt(dx0 * dx0 + dy0 * dy0 + dz0 * dz0);
    const double longer = l - l0;
    const double tension = (longer < 0 ? compressed : stretched) * longer;
    const bool isDegenerate = l <= kDegenerate * l0;
    const double scale = (isDegenerate ? 0.0 : tension) / (isDegenerate ? 1.0 : l);
    const double x = scale * dx, y = scale * dy, z = scale * dz;
    px[i] = x, py[i] = y, pz[i] = z;
    gx[i] -= x, gy[i] -= y, gz[i] -= z;
    energy[i] += tension * longer;
    const double size = std::abs(tension);
    largest[i] = largest[i] < size ? size : largest[i];
    degenerate[i] = isDegenerate ? 1.0 : degenerate[i];
  }
}

PECTORA_WIDE void springEnergies(const RowSprings<double>& springs, double* twiceEnergy) {
  const double *nx = springs.near.x, *ny = springs.near.y, *nz = springs.near.z;
  const double *fx = springs.far.x, *fy = springs.far.y, *fz = springs.far.z;
  const double *nx0 = springs.restNear.x, *ny0 = springs.restNear.y, *nz0 = springs.restNear.z;
  const double *fx0 = springs.restFar.x, *fy0 = springs.restFar.y, *fz0 = springs.restFar.z;
  double* energy = twiceEnergy;
  const double stretched = springs.stiffness, compressed = springs.stiffness * springs.compression;
  const std::size_t count = springs.count;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const double dx = fx[i] - nx[i], dy = fy[i] - ny[i], dz = fz[i] - nz[i];
    const double dx0 = fx0[i] - nx0[i], dy0 = fy0[i] - ny0[i], dz0 = fz0[i] - nz0[i];
    const double longer = std::sqrt(dx * dx + dy * dy + dz * dz) - std::sqrt(dx0 * dx0 + dy0 * dy0 + dz0 * dz0);
    const double tension = (longer < 0 ? compressed : stretched) * longer;
    energy[i] += tension * longer;
  }
}

PECTORA_WIDE void addRow(std::size_t count, ConstRow<double> source, Row<double> target) {
  const double *sx = source.x, *sy = source.y, *sz = source.z;
  double *tx = target.x, *ty = target.y, *tz = target.z;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) tx[i] += sx[i], ty[i] += sy[i], tz[i] += sz[i];
}

PECTORA_WIDE void addRow(std::size_t count, ConstRow<float> source, Row<float> target) {
  const float *sx = source.x, *sy = source.y, *sz = source.z;
  float *tx = target.x, *ty = target.y, *tz = target.z;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) tx[i] += sx[i], ty[i] += sy[i], tz[i] += sz[i];
}

PECTORA_WIDE void addRow(std::size_t count, ConstRow<float> source, Row<double> target) {
  const float *sx = source.x, *sy = source.y, *sz = source.z;
  double *tx = target.x, *ty = target.y, *tz = target.z;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) tx[i] += double(sx[i]), ty[i] += double(sy[i]), tz[i] += double(sz[i]);
}

PECTORA_WIDE void subtractRows(std::size_t count, ConstRow<double> a, ConstRow<double> b, Row<float> target) {
  const double *ax = a.x, *ay = a.y, *az = a.z, *bx = b.x, *by = b.y, *bz = b.z;
  float *tx = target.x, *ty = target.y, *tz = target.z;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) tx[i] = float(ax[i] - bx[i]), ty[i] = float(ay[i] - by[i]), tz[i] = float(az[i] - bz[i]);
}

PECTORA_WIDE bool springBlocks(const RowSprings<float>& springs, bool projected, float* const blocks[6]) {
  const float *nx = springs.near.x, *ny = springs.near.y, *nz = springs.near.z;
  const float *fx = springs.far.x, *fy = springs.far.y, *fz = springs.far.z;
  const float *nx0 = springs.restNear.x, *ny0 = springs.restNear.y, *nz0 = springs.restNear.z;
  const float *fx0 = springs.restFar.x, *fy0 = springs.restFar.y, *fz0 = springs.restFar.z;
  float *xx = blocks[0], *xy = blocks[1], *xz = blocks[2], *yy = blocks[3], *yz = blocks[4], *zz = blocks[5];
  const float stretched = springs.stiffness, compressed = springs.stiffness * springs.compression;
  const float floor = projected ? 0 : -INFINITY;
  const std::size_t count = springs.count;
  int degenerate = 0;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const Curvature c = curvatureOf(fx[i] - nx[i], fy[i] - ny[i], fz[i] - nz[i], fx0[i] - nx0[i], fy0[i] - ny0[i], fz0[i] - nz0[i],
                                    stretched, compressed, floor);
    const float bx = c.b * c.dx, by = c.b * c.dy, bz = c.b * c.dz;
    xx[i] = -(c.a + bx * c.dx), xy[i] = -bx * c.dy, xz[i] = -bx * c.dz;
    yy[i] = -(c.a + by * c.dy), yz[i] = -by * c.dz, zz[i] = -(c.a + bz * c.dz);
    degenerate |= c.isDegenerate;
  }
  return degenerate != 0;
}

PECTORA_WIDE bool curvatureProducts(const RowSprings<float>& springs, bool projected, ConstRow<float> vNear, ConstRow<float> vFar, Row<float> product,
                                    Row<float> pull) {
  const float *nx = springs.near.x, *ny = springs.near.y, *nz = springs.near.z;
  const float *fx = springs.far.x, *fy = springs.far.y, *fz = springs.far.z;
  const float *nx0 = springs.restNear.x, *ny0 = springs.restNear.y, *nz0 = springs.restNear.z;
  const float *fx0 = springs.restFar.x, *fy0 = springs.restFar.y, *fz0 = springs.restFar.z;
  const float *hx = vNear.x, *hy = vNear.y, *hz = vNear.z, *gx = vFar.x, *gy = vFar.y, *gz = vFar.z;
  float *qx = product.x, *qy = product.y, *qz = product.z, *px = pull.x, *py = pull.y, *pz = pull.z;
  const float stretched = springs.stiffness, compressed = springs.stiffness * springs.compression;
  const float floor = projected ? 0 : -INFINITY;
  const std::size_t count = springs.count;
  int degenerate = 0;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const Curvature c = curvatureOf(fx[i] - nx[i], fy[i] - ny[i], fz[i] - nz[i], fx0[i] - nx0[i], fy0[i] - ny0[i], fz0[i] - nz0[i],
                                    stretched, compressed, floor);
    const float vx = gx[i] - hx[i], vy = gy[i] - hy[i], vz = gz[i] - hz[i];
    const float along = c.b * (c.dx * vx + c.dy * vy + c.dz * vz);
    const float x = c.a * vx + along * c.dx, y = c.a * vy + along * c.dy, z = c.a * vz + along * c.dz;
    px[i] = x, py[i] = y, pz[i] = z;
    qx[i] -= x, qy[i] -= y, qz[i] -= z;
    degenerate |= c.isDegenerate;
  }
  return degenerate != 0;
}

}  // namespace pectora::lattice
