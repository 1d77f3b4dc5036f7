#include "plugins/segmenter/thorax/cartilage_wall.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>

namespace pectora::thorax {
namespace {

constexpr double kFarthestDeg = 75, kStepMm = 0.5, kRowMm = 2.5;
constexpr float kCartilageHu = 85, kBoneHu = 220;
constexpr double kShallowestMm = 6, kDeepestMm = 70, kThinnestMm = 4, kThickestMm = 18, kBehindMm = 2;
constexpr double kInsideMm = 10, kOutsideMm = 30;   // of the bony surface
constexpr double kLungMm = 8;   // from lung behind it
constexpr double kAlikeMm = 3;
constexpr double kPleuraMm = 1, kWeight = 0.02;   // behind the cartilage; of a sample, so that the wall takes no ridges from them
constexpr int kLeastAlike = 5;

/// Radius of the inner surface of the outermost cartilage on a ray, or, if asked for, bone; -1 if there is none.
double cartilageRadius(const Field& field, const PolarGrid& grid, int slice, double degrees, double skinRadius, bool orBone) {
  const double z = slice * field.spacing().z;
  double outer = -1, inner = -1, sum = 0;   // of the run; of its values
  for (double r = skinRadius - kShallowestMm; r > std::max(10.0, skinRadius - kDeepestMm - kThickestMm); r -= kStepMm) {
    const Point2 p = grid.at(slice, degrees, r);
    const float value = field.at({p.x, p.y, z});
    if (value >= kCartilageHu) {
      if (outer < 0) outer = r, sum = 0;
      inner = r, sum += value;
      continue;
    }
    if (outer < 0 || inner - r < kBehindMm) continue;
    const double thick = outer - inner;
    if (thick >= kThinnestMm && thick <= kThickestMm && (orBone || sum * kStepMm / (thick + kStepMm) < kBoneHu)) return inner - 0.5 * kStepMm;
    outer = -1;
  }
  return -1;
}

}  // namespace

std::vector<WallSample> cartilageWall(const Field& field, const PolarGrid& grid, const std::vector<std::vector<double>>& skinRadius,
                                      const std::vector<std::vector<double>>& lung,
                                      const std::vector<WallSample>& sternum, const std::vector<double>& bonySurface,
                                      const std::vector<char>& isFarFromBone, int firstSlice, double deepestLungMm) {
  constexpr int angles = PolarGrid::kAngles;
  const int slices = int(skinRadius.size()), stride = std::max(1, int(std::lround(kRowMm / field.spacing().z))), rows = (slices - 1) / stride + 1;
  std::vector<double> radius(std::size_t(rows) * angles, -1);
  std::vector<char> isSternum(radius.size(), 0);
  for (const WallSample& b : sternum) {
    const int row = int(std::lround((b.slice - firstSlice) / stride)), n = int(std::lround(b.angleIndex));
    if (row >= 0 && row < rows) isSternum[std::size_t(row) * angles + n] = 1;
  }
  parallelFor(rows, [&](std::size_t row) {
    const std::size_t s = row * stride;
    for (int n = 0; n < angles; ++n) {
      if (std::abs(PolarGrid::degrees(n)) > kFarthestDeg || skinRadius[s][n] <= 0 || isSternum[row * angles + n]) continue;
      const double r = cartilageRadius(field, grid, firstSlice + int(s), PolarGrid::degrees(n), skinRadius[s][n], isFarFromBone[s * angles + n]);
      const double bony = bonySurface[s * angles + n];
      const bool isShownByLung = std::abs(lung[s][n] - r) < kLungMm && lung[s][n] > bony - deepestLungMm;
      if (r > bony - kInsideMm && r < bony + kOutsideMm && !isShownByLung) radius[row * angles + n] = r;
    }
  });
  std::vector<WallSample> samples;
  for (int row = 1; row + 1 < rows; ++row)
    for (int n = 1; n + 1 < angles; ++n) {
      const double r = radius[std::size_t(row) * angles + n];
      int alike = -1;   // without itself
      for (int dr = -1; dr <= 1; ++dr)
        for (int dn = -1; dn <= 1; ++dn) alike += std::abs(radius[std::size_t(row + dr) * angles + n + dn] - r) < kAlikeMm;
      if (r > 0 && alike >= kLeastAlike) samples.push_back({double(n), double(firstSlice + row * stride), r - kPleuraMm, kWeight});
    }
  return samples;
}

}  // namespace pectora::thorax
