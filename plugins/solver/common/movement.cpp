#include "plugins/solver/common/movement.h"

#include <algorithm>

namespace pectora {

void Movement::apply(double t, NodeVectors& positions) const {
  drive_.apply(start_ ? 1 : t, system_.freeNodes, positions);
  if (!start_ || t >= 1) return;
  for (std::size_t i = system_.freeNodes; i < positions.size(); ++i) positions.set(i, lerp((*start_)[i], positions[i], t));
}

double Movement::longestWay() const {
  double longest = 0;
  const auto& frames = drive_.frames;
  for (std::size_t i = 0; i < frames.front().size(); ++i) {
    double way = 0;
    if (start_) way = distance((*start_)[system_.freeNodes + i], frames.back()[i]);
    else
      for (std::size_t f = 1; f < frames.size(); ++f) way += distance(frames[f - 1][i], frames[f][i]);
    longest = std::max(longest, way);
  }
  return longest;
}

}  // namespace pectora
