// Signed distance to a triangle mesh: nearest triangles and angle-weighted pseudonormals
// (Baerentzen and Aanaes, IEEE TVCG 2005), right also on open sheets.
#pragma once

#include "plugins/common/surface/closest.h"
#include "plugins/common/surface/topology.h"
#include "plugins/common/surface/triangle_bvh.h"

#include "kernel/value/mesh.h"

#include <functional>
#include <optional>
#include <span>

namespace pectora {

struct SurfaceHit {
  double distance = 0;      ///< mm; positive on the side that the triangles' normals point to
  Vec3 point;               ///< closest point of the surface
  int triangle = -1;
  Feature feature = Feature::face;   ///< where on the triangle it lies
  bool onBorder = false;    ///< the closest point lies on an open edge: the sample has no true counterpart
};

class SurfaceTree {
 public:
  /// Keeps a copy of what it needs. Throws Error if the mesh has no triangle with an area, or bad indices or coordinates.
  explicit SurfaceTree(const Mesh& mesh);

  /// The closest point; `near` is a triangle to begin with, or -1: a near one saves time and never changes the result.
  SurfaceHit closest(Vec3 p, int near = -1) const;
  /// The same of points that follow each other closely, on this thread. `hits` has their length; where its triangles are not negative,
  /// they are what to begin with.
  void closestInTurn(std::span<const Vec3> points, std::span<SurfaceHit> hits) const;
  /// The closest point of the neighbourhood: goes from the triangle `start` to those that touch it where it comes nearer to p, as long as there
  /// is one. For points that have hardly moved since their closest point was found there; a fifth of the time of `closest`. In a fold a
  /// face beside the present one may be nearer, by at most twice what the point has moved.
  SurfaceHit closestNearby(Vec3 p, int start) const;
  /// Of many points, on all threads; the same as one by one. `poll` is called now and then with the fraction done, and may throw.
  std::vector<SurfaceHit> closest(const std::vector<Vec3>& points, const std::function<void(double)>& poll) const;

  /// The unit normal of a triangle; zero if it has no area.
  Vec3 normal(int triangle) const { return topology_->pseudonormal(triangle, Feature::face); }
  const std::array<int, 3>& corners(int triangle) const { return topology_->corners(triangle); }

 private:
  ClosestPoint closestOn(int triangle, Vec3 p) const;
  NearestTriangle beginAt(int triangle, Vec3 p) const;
  SurfaceHit find(Vec3 p, const TriangleBvh::Start& start, NearestTriangle best) const;
  SurfaceHit hitAt(int triangle, const ClosestPoint& found, Vec3 p) const;

  std::optional<TriangleBvh> bvh_;
  std::optional<Topology> topology_;
};

/// The indices of points in the order of a curve that fills space (Morton), so that neighbours in the list are neighbours in space.
/// Points must be finite.
std::vector<std::int32_t> spatialOrder(const std::vector<Vec3>& points);

}  // namespace pectora
