#include "plugins/solver/common/movement.h"

#include "kernel/physics/workers.h"

#include <algorithm>

namespace pectora {

void Movement::apply(double t, NodeVectors& positions) const {
  drive_.apply(start_ ? 1 : t, system_.freeNodes, positions);
  if (!start_ || t >= 1) return;
  for (std::size_t i = system_.freeNodes; i < positions.size(); ++i) positions.set(i, lerp((*start_)[i], positions[i], t));
}

double Movement::longestWay() const {
  constexpr std::size_t kPiece = 4096;
  const auto& frames = drive_.frames;
  std::vector<double> longest(piecesOf(frames.front().size(), kPiece) + 1);
  forEachPiece(frames.front().size(), kPiece, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    double most = 0;
    for (std::size_t i = begin; i < end; ++i) {
      double way = 0;
      if (start_) way = distance((*start_)[system_.freeNodes + i], frames.back()[i]);
      else
        for (std::size_t f = 1; f < frames.size(); ++f) way += distance(frames[f - 1][i], frames[f][i]);
      most = std::max(most, way);
    }
    longest[piece] = most;
  });
  return *std::max_element(longest.begin(), longest.end());
}

}  // namespace pectora
