// Points that are drawn to where their bones carry them. A block of tissue from a point to a bone that goes by u_j pulls it, in all
// directions alike, towards x0 + u_j with stiffness k_j. Of all its blocks together only one pull matters:
//   sum 1/2 k_j |x - x0 - u_j|^2 = 1/2 K |x - x0 - u|^2 + what does not depend on x,   K = sum k_j,   u = sum k_j u_j / K.
#pragma once

#include "kernel/value/scene.h"

#include <vector>

namespace pectora {

class Carried {
 public:
  /// A block from `place` (mm, at rest) to an anchor of the scene: its stiffness in N/mm.
  void add(std::size_t node, Vec3 place, std::size_t anchor, Vec3 anchorAtRest, double stiffness);

  /// One entry for every node that was added, in order of their first block.
  struct Point {
    std::size_t node = 0;
    Vec3 place;                 ///< at rest, mm
    double stiffness = 0;       ///< K, N/mm
  };
  const std::vector<Point>& points() const { return points_; }
  /// Where the points are carried when the anchors lie at `anchors`.
  std::vector<Vec3> places(const std::vector<Vec3>& anchors) const;

 private:
  struct Block {
    std::size_t point, anchor;
    Vec3 anchorAtRest;
    double stiffness;
  };
  std::vector<Point> points_;
  std::vector<Block> blocks_;
  std::vector<std::size_t> pointOfNode_;   // one more than the index of the node's point; 0: none yet
};

}  // namespace pectora
