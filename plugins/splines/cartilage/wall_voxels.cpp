#include "plugins/splines/cartilage/wall_voxels.h"

#include "kernel/value/curve.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr double kBlockMm = 1.3;
constexpr double kSternumMm = 1.5;     // around the sternum's contours, its cortex blurs

// Whether p lies in a closed axial contour, or within `margin` of it; z is not looked at.
bool isInOrNear(const std::vector<Vec3>& contour, Vec3 p, double margin) {
  double nearest = 1e300;
  for (std::size_t n = 0; n < contour.size(); ++n) {
    const Vec3 a = contour[n], b = contour[(n + 1) % contour.size()];
    const double x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
    const double t = square > 0 ? std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / square, 0.0, 1.0) : 0;
    const double dx = p.x - a.x - t * x, dy = p.y - a.y - t * y;
    nearest = std::min(nearest, dx * dx + dy * dy);
  }
  return nearest < margin * margin || isInContour(contour, p);
}

}  // namespace

WallVoxels::WallVoxels(const Volume& ct, const Anatomy& anatomy, std::span<const Vec3> points, double marginMm, double ribMm)
    : grid_(ct.grid), sliceMm_(ct.grid.spacing.z) {
  // The box, in whole blocks within the CT.
  std::array<double, 3> low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (const Vec3& p : points) {
    const Vec3 v = grid_.toVoxel(p);
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], v[a]), high[a] = std::max(high[a], v[a]);
  }
  for (int a = 0; a < 3; ++a) {
    stride_[a] = std::max(1, int(std::lround(kBlockMm / grid_.spacing[a])));
    spacing_[a] = stride_[a] * grid_.spacing[a];
    first_[a] = std::clamp(int(std::floor(low[a] - marginMm / grid_.spacing[a])), 0, grid_.size[a] - 1);
    const int last = std::clamp(int(std::ceil(high[a] + marginMm / grid_.spacing[a])), 0, grid_.size[a] - 1);
    size_[a] = std::max(0, (last - first_[a] + 1) / stride_[a]);
  }
  average(ct);
  for (const Rib& rib : anatomy.ribs)
    if (rib.centerline.size() > 1)
      for (const Vec3& p : resamplePolyline(rib.centerline, std::max(2, int(polylineLength(rib.centerline) / 2))))
        around(p, ribMm, [&](int block, double) { isKnown_[block] = 0; });
  hideSternum(anatomy.sternum);
}

Vec3 WallVoxels::toBlock(Vec3 p) const {
  Vec3 v = grid_.toVoxel(p);
  for (int a = 0; a < 3; ++a) v[a] = (v[a] - first_[a] - 0.5 * (stride_[a] - 1)) / stride_[a];
  return v;
}

Vec3 WallVoxels::position(int block) const {
  const int at[3] = {block % size_[0], block / size_[0] % size_[1], block / size_[0] / size_[1]};
  Vec3 v;
  for (int a = 0; a < 3; ++a) v[a] = first_[a] + at[a] * stride_[a] + 0.5 * (stride_[a] - 1);
  return grid_.toPatient(v);
}

void WallVoxels::average(const Volume& ct) {
  hu_.assign(std::size_t(size_[0]) * size_[1] * size_[2], 0);
  isKnown_.assign(hu_.size(), 1);
  const auto isAirAt = [&](int i, int j, int k) {
    return ct.at(std::clamp(i, 0, grid_.size[0] - 1), std::clamp(j, 0, grid_.size[1] - 1), k) < kAirHu;
  };
  std::size_t block = 0;
  for (int k = 0; k < size_[2]; ++k)
    for (int j = 0; j < size_[1]; ++j)
      for (int i = 0; i < size_[0]; ++i, ++block) {
        const int i0 = first_[0] + i * stride_[0], j0 = first_[1] + j * stride_[1], k0 = first_[2] + k * stride_[2];
        double sum = 0;
        bool hasAir = false, hasTissue = false;
        for (int z = k0; z < k0 + stride_[2]; ++z)
          for (int y = j0; y < j0 + stride_[1]; ++y)
            for (int x = i0; x < i0 + stride_[0]; ++x) {
              sum += ct.at(x, y, z);
              for (const bool air : {isAirAt(x, y, z), isAirAt(x - 1, y, z), isAirAt(x + 1, y, z), isAirAt(x, y - 1, z), isAirAt(x, y + 1, z)})
                (air ? hasAir : hasTissue) = true;
            }
        hu_[block] = float(sum / (stride_[0] * stride_[1] * stride_[2]));
        isKnown_[block] = !(hasAir && hasTissue);
      }
}

void WallVoxels::hideSternum(const Sternum& sternum) {
  for (const std::vector<Vec3>& contour : sternum.contours) {
    if (contour.size() < 3) continue;
    const int k = int(std::lround(toBlock(contour.front()).z));
    if (k < 0 || k >= size_[2]) continue;
    Vec3 middle{};
    double reach = 0;
    for (const Vec3& p : contour) middle += p / double(contour.size());
    for (const Vec3& p : contour) reach = std::max(reach, distance(p, middle) + kSternumMm);
    for (int n = k * size_[0] * size_[1]; n < (k + 1) * size_[0] * size_[1]; ++n) {
      const Vec3 p = position(n);
      if (isKnown_[n] && std::abs(p.x - middle.x) < reach && std::abs(p.y - middle.y) < reach && isInOrNear(contour, p, kSternumMm)) isKnown_[n] = 0;
    }
  }
}

}  // namespace pectora
