// A signed distance field through noisy points: radial basis functions on overlapping balls, blended.
#pragma once

#include "plugins/scan/common/neighbours.h"

#include <array>
#include <functional>
#include <unordered_map>

namespace pectora {

struct FieldSettings {
  double noise = 0.5;        ///< standard deviation of the points along their normals, mm
  double coarseCell = 40;    ///< side of the wide balls' cells, which bridge holes, mm
};

/// Polyharmonic functions r^3 with a linear polynomial (Carr et al., SIGGRAPH 2001, equations 6 to 9 with their smoothing), fitted ball by ball
/// to points (value 0) and to points off the surface along the normals (value their distance), and blended by Wendland's function
/// as a partition of unity (Wendland 2002). Where no fine ball reaches, wide ones take over.
class RbfField {
 public:
  /// Points and unit outward normals, finite, one each. `poll` is called with the fraction done, and may throw.
  RbfField(const std::vector<Vec3>& points, const std::vector<Vec3>& normals, const Neighbours& tree, const FieldSettings& settings,
           const std::function<void(double)>& poll);

  /// About the signed distance to the surface, mm, positive outside; NaN where no ball reaches.
  double operator()(Vec3 p) const;
  std::size_t balls() const { return balls_.size(); }

 private:
  struct Ball {
    Vec3 center;
    double radius = 0;
    bool isWide = false;
    std::vector<double> x, y, z, weight;   // centres about the ball's, in radii
    std::array<double, 4> linear{};
  };
  void fit(Ball& ball, const std::vector<Vec3>& points, const std::vector<Vec3>& normals, const Neighbours& tree, double noise) const;
  double evaluate(const Ball& ball, Vec3 p) const;
  std::uint64_t key(Vec3 p) const;

  std::vector<Ball> balls_;
  std::unordered_map<std::uint64_t, std::vector<std::int32_t>> cells_;   // balls that touch a cell of the grid
  double cell_ = 1;
};

}  // namespace pectora
