// The body and the lungs on a coarse copy of the CT.
#pragma once

#include "plugins/segmenter/thorax/field.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace pectora::thorax {

/// A coarse copy of the CT (blocks of factor x factor voxels within a slice are averaged, slices are kept) with the
/// masks that the later steps start from. Coarse pixel (i, j) is centred on voxel ((i + 0.5) * factor - 0.5, ...).
struct Body {
  int factor = 1;
  std::array<int, 3> size{};
  Vec3 spacing;                      ///< mm, coarse
  std::vector<std::int16_t> hu;      ///< block means, not below -1024
  std::vector<std::uint8_t> mask;    ///< bit kTorso, kLung
  int firstSlice = 0, lastSlice = 0; ///< range of slices that hold body
  Box box;                           ///< of the torso, in voxels of the CT
  bool hasLungs = false;

  static constexpr std::uint8_t kTorso = 1;  ///< the body with everything inside it
  static constexpr std::uint8_t kLung = 2;

  std::size_t index(int i, int j, int k) const { return (std::size_t(k) * size[1] + j) * size[0] + i; }
  bool isTorso(int i, int j, int k) const { return mask[index(i, j, k)] & kTorso; }
  bool isLung(int i, int j, int k) const { return mask[index(i, j, k)] & kLung; }
  /// Local mm of a coarse pixel (may be between pixels).
  Vec3 position(double i, double j, double k) const {
    const double shift = 0.5 * (1 - 1.0 / factor);
    return {(i + shift) * spacing.x, (j + shift) * spacing.y, k * spacing.z};
  }
  /// Coarse pixel nearest to a local position, clamped to the volume.
  std::array<int, 3> nearest(Vec3 local) const;
};

/// Finds the body: everything above -300 HU, opened by about 3 mm so that couch, clothes and cables fall off, the
/// largest connected piece, its cavities filled slice by slice. Lungs are the cavities of at least 30 mL, not less
/// than a tenth of the largest, that hold lung (mean above -960 HU) and not gas.
/// Throws Error if there is no body: less than 50 mL of it, or nothing but solid.
Body findBody(const Volume& ct, const std::function<void(double)>& step = {});

}  // namespace pectora::thorax
