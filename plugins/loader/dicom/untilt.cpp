#include "plugins/loader/dicom/untilt.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>

namespace pectora::dicom {
namespace {

constexpr std::int16_t kOutside = -1024;

/// A shift by whole voxels and a part between them.
struct Shift {
  int whole;
  double part;   // 0 to 1
};
Shift shiftOf(double voxels) {
  // A sum of steps that is meant to be whole should not blur.
  const double nearest = std::round(voxels);
  if (std::abs(voxels - nearest) < 1e-6) return {int(nearest), 0};
  return {int(std::floor(voxels)), voxels - std::floor(voxels)};
}

}  // namespace

Volume untilt(const Volume& sheared, double driftX, double driftY) {
  const Grid& from = sheared.grid;
  const double drift[2] = {driftX, driftY};
  Volume straight;
  straight.grid = from;
  int start[2];
  for (int axis = 0; axis < 2; ++axis) {
    // Room for the slice that is farthest out, on the side on which it is.
    const double total = drift[axis] * (from.size[2] - 1);
    start[axis] = int(std::floor(std::min(0.0, total) + 1e-6));
    straight.grid.size[std::size_t(axis)] = from.size[std::size_t(axis)] + int(std::ceil(std::abs(total) - 1e-6));
    straight.grid.origin += from.axes[std::size_t(axis)] * (from.spacing[axis] * start[axis]);
  }
  const Grid& to = straight.grid;
  straight.hu.assign(to.voxels(), kOutside);
  parallelFor(std::size_t(to.size[2]), [&](std::size_t k) {
    const Shift x = shiftOf(start[0] - driftX * double(k)), y = shiftOf(start[1] - driftY * double(k));
    const auto value = [&](int i, int j) {
      const bool isInside = i >= 0 && i < from.size[0] && j >= 0 && j < from.size[1];
      return double(isInside ? sheared.hu[from.index(i, j, int(k))] : kOutside);
    };
    for (int j = 0; j < to.size[1]; ++j) {
      for (int i = 0; i < to.size[0]; ++i) {
        const int u = i + x.whole, v = j + y.whole;
        if (u < -1 || v < -1 || u >= from.size[0] || v >= from.size[1]) continue;
        double hu = (1 - x.part) * (1 - y.part) * value(u, v);
        if (x.part > 0) hu += x.part * (1 - y.part) * value(u + 1, v);
        if (y.part > 0) hu += (1 - x.part) * y.part * value(u, v + 1);
        if (x.part > 0 && y.part > 0) hu += x.part * y.part * value(u + 1, v + 1);
        straight.hu[to.index(i, j, int(k))] = std::int16_t(std::lround(hu));
      }
    }
  });
  return straight;
}

}  // namespace pectora::dicom
