// The order in which a balanced tree holds its leaves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pectora {

/// A point that stands for something.
struct TreeItem {
  float center[3];
  std::int32_t id;   ///< no two items have the same
};

/// The items' ids, halved again and again along the longest side, at a power of two times `run`: every aligned stretch of
/// run * 2^k ids lies close together. Works on all threads; the same for any number of them.
std::vector<std::int32_t> balancedOrder(std::vector<TreeItem> items, std::size_t run);

}  // namespace pectora
