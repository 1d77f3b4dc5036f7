#include "plugins/scan/common/neighbours.h"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>

namespace pectora {
namespace {

struct Cloud {
  const std::vector<Vec3>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][int(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const { return false; }
};

using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::int32_t>;

}  // namespace

struct Neighbours::Tree {
  Cloud cloud;
  Index index;
  explicit Tree(const std::vector<Vec3>& points) : cloud{points}, index(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16)) { index.buildIndex(); }
};

Neighbours::Neighbours(const std::vector<Vec3>& points) : tree_(std::make_unique<Tree>(points)) {}
Neighbours::~Neighbours() = default;

void Neighbours::nearest(Vec3 p, int k, std::vector<std::int32_t>& indices, std::vector<double>& squared) const {
  const double query[3] = {p.x, p.y, p.z};
  indices.resize(std::size_t(k));
  squared.resize(std::size_t(k));
  const std::size_t found = tree_->index.knnSearch(query, std::size_t(k), indices.data(), squared.data());
  indices.resize(found);
  squared.resize(found);
}

void Neighbours::within(Vec3 p, double radius, std::vector<std::int32_t>& indices) const {
  const double query[3] = {p.x, p.y, p.z};
  std::vector<std::pair<std::int32_t, double>> found;
  nanoflann::SearchParams parameters;
  parameters.sorted = false;
  tree_->index.radiusSearch(query, radius * radius, found, parameters);
  indices.clear();
  for (const auto& [index, squared] : found) indices.push_back(index);
  std::sort(indices.begin(), indices.end());
}

double Neighbours::distance(Vec3 p) const {
  const double query[3] = {p.x, p.y, p.z};
  std::int32_t index = 0;
  double squared = INFINITY;
  tree_->index.knnSearch(query, 1, &index, &squared);
  return std::sqrt(squared);
}

}  // namespace pectora
