#include "plugins/effect/attachment/carried.h"

#include <algorithm>

namespace pectora {

void Carried::add(std::size_t node, Vec3 place, std::size_t anchor, Vec3 anchorAtRest, double stiffness) {
  pointOfNode_.resize(std::max(pointOfNode_.size(), node + 1));
  if (pointOfNode_[node] == 0) {
    points_.push_back({node, place, 0});
    pointOfNode_[node] = points_.size();
  }
  const std::size_t point = pointOfNode_[node] - 1;
  points_[point].stiffness += stiffness;
  blocks_.push_back({point, anchor, anchorAtRest, stiffness});
}

std::vector<Vec3> Carried::places(const std::vector<Vec3>& anchors) const {
  std::vector<Vec3> places;
  places.reserve(points_.size());
  for (const Point& p : points_) places.push_back(p.place);
  for (const Block& b : blocks_) places[b.point] += (anchors[b.anchor] - b.anchorAtRest) * (b.stiffness / points_[b.point].stiffness);
  return places;
}

}  // namespace pectora
