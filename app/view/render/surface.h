// What is drawn: triangles or points with normals and a figure each, and the shapes that are made of them.
#pragma once

#include "app/view/render/camera.h"

#include "kernel/value/mesh.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace pectora::view {

struct Surface {
  std::vector<Vec3> points;                       ///< LPS mm
  std::vector<Vec3> normals;                      ///< one a point; empty until computeNormals
  std::vector<double> values;                     ///< one a point, or empty; NaN: unknown
  std::vector<std::array<int, 3>> triangles;      ///< empty: a cloud of points

  void computeNormals();
  void append(const Surface& other);
};

/// A tube of `sides` around a line; `radius` mm.
Surface tube(std::span<const Vec3> line, double radius, int sides = 10);
/// The skin over closed contours, one above the other, closed at both ends.
Surface loft(const std::vector<std::vector<Vec3>>& contours);
/// A bar: a rectangle of `width` (along the unit vector `up`) by `height`, swept along its centre line.
Surface sweptBar(std::span<const Vec3> line, Vec3 up, double width, double height);
Surface ball(Vec3 center, double radius);

/// About how far apart the points of a cloud lie on the surface that they are of, mm; 0 for fewer than two places.
double pointSpacing(std::span<const Vec3> points);

struct Hit {
  Vec3 position;
  double distance = 0;   ///< along the ray, mm
  int point = 0;         ///< the nearest point of the surface
};
/// The first triangle that a ray meets, or of a cloud the first point within 3 mm of it.
std::optional<Hit> pick(const Surface& surface, const Ray& ray);

}  // namespace pectora::view
