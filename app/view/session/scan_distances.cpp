#include "app/view/session/scan_distances.h"

#include <nanoflann.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

namespace pectora::view {
namespace {

constexpr double kAside = 5;   // mm, from a point of the skin along it to the cloud's point that speaks for it

// The points of a cloud, as nanoflann wants to see them.
struct Known {
  std::vector<Vec3> points;
  std::vector<double> distances;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][int(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const { return false; }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Known>, Known, 3>;

const std::vector<double>* distancesOf(const std::vector<PointField>& fields) {
  for (const PointField& field : fields)
    if (field.name == "distance") return &field.values;
  return nullptr;
}

}  // namespace

std::vector<double> scanDistances(const Comparison& comparison, const std::vector<Vec3>& skin) {
  if (comparison.reference && comparison.reference->points.size() == skin.size())
    if (const auto* measured = distancesOf(comparison.reference->fields)) return *measured;
  std::vector<double> found(skin.size(), std::numeric_limits<double>::quiet_NaN());
  const auto* cloud = dynamic_cast<const Points*>(comparison.sample.get());
  const auto* measured = cloud ? distancesOf(cloud->fields) : nullptr;
  if (!measured) return found;

  Known known;
  for (std::size_t i = 0; i < cloud->points.size(); ++i)
    if (std::isfinite((*measured)[i])) known.points.push_back(cloud->points[i]), known.distances.push_back((*measured)[i]);
  if (known.points.empty()) return found;
  Tree tree(3, known, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  tree.buildIndex();
  for (std::size_t i = 0; i < skin.size(); ++i) {
    const double at[3] = {skin[i].x, skin[i].y, skin[i].z};
    std::uint32_t nearest = 0;
    double squared = 0;
    tree.knnSearch(at, 1, &nearest, &squared);
    const double d = known.distances[nearest];
    if (squared <= d * d + kAside * kAside) found[i] = d;
  }
  return found;
}

}  // namespace pectora::view
