#include "kernel/physics/lattice_rows.h"

#include <cmath>

// One copy of each loop for wide registers, chosen when the program is loaded. (Sanitizers do not survive the choice.)
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PECTORA_WIDE __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define PECTORA_WIDE
#endif

namespace pectora::lattice {

PECTORA_WIDE void springForces(const RowSprings& springs, Row pull, RowSums sums) {
  const double *nx = springs.near.x, *ny = springs.near.y, *nz = springs.near.z;
  const double *fx = springs.far.x, *fy = springs.far.y, *fz = springs.far.z;
  const double* rest = springs.restLength;
  double *px = pull.x, *py = pull.y, *pz = pull.z;
  double *energy = sums.twiceEnergy, *largest = sums.largest, *degenerate = sums.degenerate;
  const double stretched = springs.stiffness, compressed = springs.stiffness * springs.compression;
  const std::size_t count = springs.count;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const double dx = fx[i] - nx[i], dy = fy[i] - ny[i], dz = fz[i] - nz[i], l0 = rest[i];
    const double l = std::sqrt(dx * dx + dy * dy + dz * dz);
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

PECTORA_WIDE void springEnergies(const RowSprings& springs, double* twiceEnergy) {
  const double *nx = springs.near.x, *ny = springs.near.y, *nz = springs.near.z;
  const double *fx = springs.far.x, *fy = springs.far.y, *fz = springs.far.z;
  const double* rest = springs.restLength;
  double* energy = twiceEnergy;
  const double stretched = springs.stiffness, compressed = springs.stiffness * springs.compression;
  const std::size_t count = springs.count;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const double dx = fx[i] - nx[i], dy = fy[i] - ny[i], dz = fz[i] - nz[i];
    const double longer = std::sqrt(dx * dx + dy * dy + dz * dz) - rest[i];
    const double tension = (longer < 0 ? compressed : stretched) * longer;
    energy[i] += tension * longer;
  }
}

PECTORA_WIDE void addRow(std::size_t count, ConstRow source, double sign, Row target) {
  const double *sx = source.x, *sy = source.y, *sz = source.z;
  double *tx = target.x, *ty = target.y, *tz = target.z;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) tx[i] += sign * sx[i], ty[i] += sign * sy[i], tz[i] += sign * sz[i];
}

PECTORA_WIDE void springCurvatures(const RowSprings& springs, bool projected, RowCurvature curvature, double* degenerate) {
  const double *nx = springs.near.x, *ny = springs.near.y, *nz = springs.near.z;
  const double *fx = springs.far.x, *fy = springs.far.y, *fz = springs.far.z;
  const double* rest = springs.restLength;
  float *mx = curvature.mx, *my = curvature.my, *mz = curvature.mz, *as = curvature.a;
  const double stretched = springs.stiffness, compressed = springs.stiffness * springs.compression;
  const double floor = projected ? 0 : -INFINITY;
  const std::size_t count = springs.count;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const double dx = fx[i] - nx[i], dy = fy[i] - ny[i], dz = fz[i] - nz[i], l0 = rest[i];
    const double l = std::sqrt(dx * dx + dy * dy + dz * dz);
    const bool isDegenerate = l <= kDegenerate * l0;
    const double k = isDegenerate ? 0.0 : l < l0 ? compressed : stretched;
    const double safe = isDegenerate ? 1.0 : l;
    const double across = k * (1 - l0 / safe);
    const double a = isDegenerate ? 0.0 : across < floor ? floor : across;
    const double m = std::sqrt(k - a) / safe;
    mx[i] = float(m * dx), my[i] = float(m * dy), mz[i] = float(m * dz), as[i] = float(a);
    degenerate[i] = isDegenerate ? 1.0 : degenerate[i];
  }
}

PECTORA_WIDE void curvatureProducts(std::size_t count, ConstRow near, ConstRow far, RowCurvature curvature, Row pull) {
  const double *nx = near.x, *ny = near.y, *nz = near.z;
  const double *fx = far.x, *fy = far.y, *fz = far.z;
  const float *mx = curvature.mx, *my = curvature.my, *mz = curvature.mz, *as = curvature.a;
  double *px = pull.x, *py = pull.y, *pz = pull.z;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const double dx = fx[i] - nx[i], dy = fy[i] - ny[i], dz = fz[i] - nz[i];
    const double ux = double(mx[i]), uy = double(my[i]), uz = double(mz[i]), a = double(as[i]);
    const double along = ux * dx + uy * dy + uz * dz;
    px[i] = a * dx + along * ux, py[i] = a * dy + along * uy, pz[i] = a * dz + along * uz;
  }
}

}  // namespace pectora::lattice
