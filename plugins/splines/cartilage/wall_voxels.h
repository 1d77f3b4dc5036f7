// The part of a CT around some curves, averaged over blocks of voxels, with what may be asked there.
#pragma once

#include "kernel/value/anatomy.h"
#include "kernel/value/volume.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace pectora {

/// Blocks of about 1.3 mm (or one voxel, where that is larger) around given points. A block is unknown where it says nothing of
/// cartilage: at ribs and sternum, and where air begins, because of the partial volume.
class WallVoxels {
 public:
  /// All within `marginMm` of the points. `ribMm` around the ribs' lines is unknown.
  WallVoxels(const Volume& ct, const Anatomy& anatomy, std::span<const Vec3> points, double marginMm, double ribMm);

  int count() const { return int(hu_.size()); }
  float hu(int block) const { return hu_[block]; }              ///< mean of the block's voxels
  bool isKnown(int block) const { return isKnown_[block]; }
  bool isAir(int block) const { return hu_[block] < kAirHu; }
  Vec3 position(int block) const;                               ///< middle of the block, LPS mm
  Vec3 spacing() const { return spacing_; }                     ///< of the blocks, mm
  double sliceMm() const { return sliceMm_; }                   ///< thickness of the CT's slices

  /// Calls f(block, squared distance) for every block whose middle is within `radius` of p.
  template <class F>
  void around(Vec3 p, double radius, F&& f) const {
    const Vec3 c = toBlock(p);
    int from[3], to[3];
    for (int a = 0; a < 3; ++a) {
      from[a] = std::max(0, int(std::ceil(c[a] - radius / spacing_[a])));
      to[a] = std::min(size_[a] - 1, int(std::floor(c[a] + radius / spacing_[a])));
    }
    for (int k = from[2]; k <= to[2]; ++k)
      for (int j = from[1]; j <= to[1]; ++j)
        for (int i = from[0]; i <= to[0]; ++i) {
          const double x = (i - c.x) * spacing_.x, y = (j - c.y) * spacing_.y, z = (k - c.z) * spacing_.z, d = x * x + y * y + z * z;
          if (d <= radius * radius) f((k * size_[1] + j) * size_[0] + i, d);
        }
  }

 private:
  static constexpr float kAirHu = -385;   // halfway from lung to cartilage
  Vec3 toBlock(Vec3 p) const;
  void average(const Volume& ct);
  void hideSternum(const Sternum& sternum);

  const Grid& grid_;
  std::array<int, 3> first_{}, stride_{}, size_{};   // in voxels; of the box in blocks
  Vec3 spacing_;
  double sliceMm_;
  std::vector<float> hu_;
  std::vector<char> isKnown_;
};

}  // namespace pectora
