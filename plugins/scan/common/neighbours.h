// Nearest points of a cloud.
#pragma once

#include "kernel/value/vec3.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace pectora {

/// A tree over points, which must outlive it, be finite, and not change.
class Neighbours {
 public:
  explicit Neighbours(const std::vector<Vec3>& points);
  ~Neighbours();

  /// The k nearest points, nearest first (fewer if there are fewer), and their squared distances in mm^2.
  void nearest(Vec3 p, int k, std::vector<std::int32_t>& indices, std::vector<double>& squared) const;
  /// All points within a radius, by index.
  void within(Vec3 p, double radius, std::vector<std::int32_t>& indices) const;
  /// Distance to the nearest point, mm.
  double distance(Vec3 p) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace pectora
