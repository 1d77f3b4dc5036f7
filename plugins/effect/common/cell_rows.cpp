#include "plugins/effect/common/cell_rows.h"

#include <algorithm>

namespace pectora::cells {
namespace {

// With I - 3 = 2 tr H + H : H the parts of first order cancel: mu (H : H / 2 - small) + mu/6 (J - 1)^2 at every point.
PECTORA_INLINE Pack energyOf(const Deformation& s, const RestPack& rest) {
  Pack sum{}, volume{};
  for (int q = 0; q < kPoints; ++q) {
    Pack square{};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) square += s.displacement[q][i][k] * s.displacement[q][i][k];
    sum += rest.weight[q] * (0.5 * square - s.small[q] + (1.0 / 6) * s.grown[q] * s.grown[q]);
    volume += rest.weight[q];
  }
  return rest.shear * sum + 0.5 * volume * rest.bulk * s.meanGrown * s.meanGrown;
}

// In the order of the lanes.
PECTORA_INLINE double total(const Pack& p) {
  double sum = 0;
  for (int lane = 0; lane < kLanes; ++lane) sum += p[lane];
  return sum;
}

}  // namespace

PECTORA_WIDE double cellEnergy(const Run& run, const RestPack& rest) {
  Deformation s;
  deform(run, rest, s);
  return total(energyOf(s, rest));
}

PECTORA_WIDE double cellForces(const Run& run, const RestPack& rest, const ForceRows& forces, double& largestSquared) {
  Deformation s;
  deform(run, rest, s);
  const Pack pressure = rest.bulk * s.meanGrown;
  // Piola stress P = mu (F - cof F) + (mu/3 (J - 1) + kappa (Jm - 1)) cof F, then along the directions of the cell.
  Pack pulled[3][3][4] = {};
  for (int q = 0; q < kPoints; ++q) {
    const Pack c = (1.0 / 3) * rest.shear * s.grown[q] + pressure;
    for (int i = 0; i < 3; ++i) {
      Pack stress[3];
      for (int k = 0; k < 3; ++k) {
        const Pack identity = Pack{} + (i == k ? 1.0 : 0.0);
        const Pack apart = s.displacement[q][i][k] - (s.cofactor[q][i][k] - identity);
        stress[k] = rest.weight[q] * (rest.shear * apart + c * s.cofactor[q][i][k]);
      }
      for (int j = 0; j < 3; ++j)
        pulled[i][j][across(j, q)] += stress[0] * rest.inverse[q][j][0] + stress[1] * rest.inverse[q][j][1] + stress[2] * rest.inverse[q][j][2];
    }
  }
  Pack squared[kCorners] = {};
  for (int i = 0; i < 3; ++i) {
    Pack force[kCorners] = {};
    addTransposed(pulled[i], force);
    for (int a = 0; a < kCorners; ++a) {
      squared[a] += force[a] * force[a];
      double* row = forces.rows[i][a >> 1] + (a & 1);
      for (int lane = 0; lane < run.count; ++lane) row[lane] += force[a][lane];
    }
  }
  for (int a = 0; a < kCorners; ++a)
    for (int lane = 0; lane < run.count; ++lane) largestSquared = std::max(largestSquared, squared[a][lane]);
  return total(energyOf(s, rest));
}

}  // namespace pectora::cells
