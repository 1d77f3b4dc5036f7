// Connected components of a mask.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace pectora::thorax {

/// Components of `mask` (nonzero voxels that share a face), numbered from 1 in the order of their first voxel.
struct Components {
  std::vector<std::int32_t> label;     ///< 0 = background
  std::vector<std::size_t> voxels;     ///< voxels[n - 1] is the size of component n
  int largest() const;                 ///< number of the largest (the first of equals), 0 if there is none
};
Components components(const std::vector<std::uint8_t>& mask, std::array<int, 3> size);

}  // namespace pectora::thorax
