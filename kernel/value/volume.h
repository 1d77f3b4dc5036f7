// A CT as a regular grid of Hounsfield units, and label volumes on the same grid.
#pragma once

#include "kernel/value/value.h"
#include "kernel/value/vec3.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace pectora {

/// A regular grid of voxel centres. Axis 0 runs along an image row, axis 1 down its columns, axis 2 through the
/// slices towards the head. For an axial CT the axes are close to LPS x, y and z.
struct Grid {
  std::array<int, 3> size{};                       ///< voxels along each axis
  Vec3 spacing{1, 1, 1};                           ///< mm between voxel centres
  Vec3 origin{};                                   ///< LPS position of the centre of voxel (0, 0, 0), mm
  std::array<Vec3, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< orthonormal, right-handed

  std::size_t voxels() const { return std::size_t(size[0]) * size[1] * size[2]; }
  std::size_t sliceVoxels() const { return std::size_t(size[0]) * size[1]; }
  std::size_t index(int i, int j, int k) const { return (std::size_t(k) * size[1] + j) * size[0] + i; }
  /// Continuous voxel coordinates to LPS mm.
  Vec3 toPatient(Vec3 voxel) const {
    return origin + axes[0] * (voxel.x * spacing.x) + axes[1] * (voxel.y * spacing.y) +
           axes[2] * (voxel.z * spacing.z);
  }
  /// LPS mm to continuous voxel coordinates.
  Vec3 toVoxel(Vec3 patient) const {
    const Vec3 d = patient - origin;
    return {dot(d, axes[0]) / spacing.x, dot(d, axes[1]) / spacing.y, dot(d, axes[2]) / spacing.z};
  }
};

/// A CT volume.
struct Volume : Value {
  static constexpr const char* kName = "Volume";
  Grid grid;
  std::vector<std::int16_t> hu;  ///< Hounsfield units, grid.voxels() of them, axis 0 fastest

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
  std::size_t bytes() const override { return hu.size() * sizeof(hu[0]); }
  std::int16_t at(int i, int j, int k) const { return hu[grid.index(i, j, k)]; }
};

/// A label for every voxel; `names[v]` says what value v means, 0 is background.
struct Labels : Value {
  static constexpr const char* kName = "Labels";
  Grid grid;
  std::vector<std::uint8_t> label;
  std::vector<std::string> names;

  const char* kind() const override { return kName; }
  std::size_t bytes() const override { return label.size(); }
};

}  // namespace pectora
