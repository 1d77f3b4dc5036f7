#include "plugins/segmenter/thorax/frame.h"

#include <algorithm>
#include <cmath>

namespace pectora::thorax {

std::shared_ptr<const Volume> upright(std::shared_ptr<const Volume> ct) {
  // Of the six permutations, the one whose axes agree best with left, back and head.
  const Grid& from = ct->grid;
  std::array<int, 3> order{0, 1, 2}, best = order;
  double bestScore = -1;
  do {
    double score = 0;
    for (int a = 0; a < 3; ++a) score += std::abs(from.axes[order[a]][a]);
    if (score > bestScore + 1e-9) bestScore = score, best = order;
  } while (std::next_permutation(order.begin(), order.end()));
  std::array<bool, 3> flipped{};
  for (int a = 0; a < 3; ++a) flipped[a] = from.axes[best[a]][a] < 0;
  if (best == std::array<int, 3>{0, 1, 2} && !flipped[0] && !flipped[1] && !flipped[2]) return ct;

  auto result = std::make_shared<Volume>();
  Grid& to = result->grid;
  Vec3 corner{};
  for (int a = 0; a < 3; ++a) {
    to.size[a] = from.size[best[a]];
    to.spacing[a] = from.spacing[best[a]];
    to.axes[a] = flipped[a] ? -from.axes[best[a]] : from.axes[best[a]];
    corner[best[a]] = flipped[a] ? from.size[best[a]] - 1 : 0;
  }
  to.origin = from.toPatient(corner);
  result->hu.resize(to.voxels());
  std::array<int, 3> p{};
  std::size_t n = 0;
  for (int k = 0; k < to.size[2]; ++k)
    for (int j = 0; j < to.size[1]; ++j)
      for (int i = 0; i < to.size[0]; ++i) {
        p[best[0]] = flipped[0] ? to.size[0] - 1 - i : i;
        p[best[1]] = flipped[1] ? to.size[1] - 1 - j : j;
        p[best[2]] = flipped[2] ? to.size[2] - 1 - k : k;
        result->hu[n++] = ct->at(p[0], p[1], p[2]);
      }
  return result;
}

}  // namespace pectora::thorax
