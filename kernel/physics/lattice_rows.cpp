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

PECTORA_WIDE void springForces(const RowSprings<double>& springs, Row<double> pull, RowSums sums) {
  const double *nx = springs.near.x, *ny = springs.near.y, *nz = springs.near.z;
  const double *fx = springs.far.x, *fy = springs.far.y, *fz = springs.far.z;
  const double *nx0 = springs.restNear.x, *ny0 = springs.restNear.y, *nz0 = springs.restNear.z;
  const double *fx0 = springs.restFar.x, *fy0 = springs.restFar.y, *fz0 = springs.restFar.z;
  double *px = pull.x, *py = pull.y, *pz = pull.z;
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
    px[i] = scale * dx, py[i] = scale * dy, pz[i] = scale * dz;
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

PECTORA_WIDE void addRow(std::size_t count, ConstRow<double> source, double sign, Row<double> target) {
  const double *sx = source.x, *sy = source.y, *sz = source.z;
  double *tx = target.x, *ty = target.y, *tz = target.z;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) tx[i] += sign * sx[i], ty[i] += sign * sy[i], tz[i] += sign * sz[i];
}

PECTORA_WIDE void addRow(std::size_t count, ConstRow<float> source, float sign, Row<float> target) {
  const float *sx = source.x, *sy = source.y, *sz = source.z;
  float *tx = target.x, *ty = target.y, *tz = target.z;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) tx[i] += sign * sx[i], ty[i] += sign * sy[i], tz[i] += sign * sz[i];
}

PECTORA_WIDE bool springCurvatures(const RowSprings<float>& springs, bool projected, RowCurvature curvature) {
  const float *nx = springs.near.x, *ny = springs.near.y, *nz = springs.near.z;
  const float *fx = springs.far.x, *fy = springs.far.y, *fz = springs.far.z;
  const float *nx0 = springs.restNear.x, *ny0 = springs.restNear.y, *nz0 = springs.restNear.z;
  const float *fx0 = springs.restFar.x, *fy0 = springs.restFar.y, *fz0 = springs.restFar.z;
  float *as = curvature.a, *bs = curvature.b;
  const float stretched = springs.stiffness, compressed = springs.stiffness * springs.compression;
  const float floor = projected ? 0 : -INFINITY;
  const std::size_t count = springs.count;
  int degenerate = 0;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const Curvature c = curvatureOf(fx[i] - nx[i], fy[i] - ny[i], fz[i] - nz[i], fx0[i] - nx0[i], fy0[i] - ny0[i], fz0[i] - nz0[i],
                                    stretched, compressed, floor);
    as[i] = c.a, bs[i] = c.b;
    degenerate |= c.isDegenerate;
  }
  return degenerate != 0;
}

PECTORA_WIDE bool curvatureProducts(const RowSprings<float>& springs, bool projected, ConstRow<float> vNear, ConstRow<float> vFar, Row<float> pull) {
  const float *nx = springs.near.x, *ny = springs.near.y, *nz = springs.near.z;
  const float *fx = springs.far.x, *fy = springs.far.y, *fz = springs.far.z;
  const float *nx0 = springs.restNear.x, *ny0 = springs.restNear.y, *nz0 = springs.restNear.z;
  const float *fx0 = springs.restFar.x, *fy0 = springs.restFar.y, *fz0 = springs.restFar.z;
  const float *hx = vNear.x, *hy = vNear.y, *hz = vNear.z, *gx = vFar.x, *gy = vFar.y, *gz = vFar.z;
  float *px = pull.x, *py = pull.y, *pz = pull.z;
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
    px[i] = c.a * vx + along * c.dx, py[i] = c.a * vy + along * c.dy, pz[i] = c.a * vz + along * c.dz;
    degenerate |= c.isDegenerate;
  }
  return degenerate != 0;
}

}  // namespace pectora::lattice
