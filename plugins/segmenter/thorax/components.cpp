#include "plugins/segmenter/thorax/components.h"

#include <algorithm>
#include <numeric>

namespace pectora::thorax {
namespace {

/// Union-find over provisional labels; the smaller label becomes the root, so that numbering follows first voxels.
struct Forest {
  std::vector<std::int32_t> parent{0};
  std::int32_t add() {
    parent.push_back(std::int32_t(parent.size()));
    return parent.back();
  }
  std::int32_t root(std::int32_t a) {
    while (parent[a] != a) a = parent[a] = parent[parent[a]];
    return a;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = root(a), b = root(b);
    if (a < b) parent[b] = a;
    else parent[a] = b;
  }
};

}  // namespace

int Components::largest() const {
  return voxels.empty() ? 0 : int(std::max_element(voxels.begin(), voxels.end()) - voxels.begin()) + 1;
}

Components components(const std::vector<std::uint8_t>& mask, std::array<int, 3> size) {
  Components result;
  result.label.assign(mask.size(), 0);
  Forest forest;
  const std::size_t w = size[0], area = w * size[1];
  std::size_t n = 0;
  for (int k = 0; k < size[2]; ++k)
    for (int j = 0; j < size[1]; ++j)
      for (int i = 0; i < size[0]; ++i, ++n) {
        if (!mask[n]) continue;
        std::int32_t label = 0;
        const auto touch = [&](std::size_t neighbour) {
          const std::int32_t other = result.label[neighbour];
          if (!other) return;
          if (!label) label = other;
          else if (label != other) forest.join(label, other);
        };
        if (i) touch(n - 1);
        if (j) touch(n - w);
        if (k) touch(n - area);
        result.label[n] = label ? label : forest.add();
      }
  // Roots are numbered in the order of their first voxels.
  std::vector<std::int32_t> number(forest.parent.size(), 0);
  for (std::int32_t& label : result.label) {
    if (!label) continue;
    const std::int32_t root = forest.root(label);
    if (!number[root]) {
      result.voxels.push_back(0);
      number[root] = std::int32_t(result.voxels.size());
    }
    label = number[root];
    ++result.voxels[label - 1];
  }
  return result;
}

}  // namespace pectora::thorax
