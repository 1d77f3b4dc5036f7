// The eye that a scene is seen with. It turns about a target; the patient's head is up.
#pragma once

#include "kernel/value/vec3.h"

#include <array>

namespace pectora::view {

/// Column by column, as OpenGL takes it.
using Matrix4 = std::array<float, 16>;

struct Ray {
  Vec3 origin, direction;   ///< direction is a unit vector
};

struct Camera {
  Vec3 target;              ///< LPS mm
  double distance = 900;    ///< from eye to target, mm
  double yaw = 0;           ///< rad about z; 0: from the front, pi / 2: from the patient's left
  double pitch = 0;         ///< rad; positive: from above
  double aspect = 1;        ///< width over height

  Vec3 eye() const;
  Vec3 right() const;
  Vec3 up() const;
  Matrix4 matrix() const;   ///< LPS mm to clip coordinates
  /// Through a place of the picture: x and y from 0 (left, top) to 1.
  Ray ray(double x, double y) const;
  /// Where that ray meets the plane through a point that is parallel to the picture. The point lies before the eye.
  Vec3 onPlane(Vec3 through, double x, double y) const;
  /// Where a point stands in the picture; z is its distance along the view, negative behind the eye.
  Vec3 project(Vec3 point) const;
  /// Turns by mouse: parts of the picture's height.
  void orbit(double dx, double dy);
  void pan(double dx, double dy);
  void zoom(double factor);
  /// Shows a ball whole.
  void frame(Vec3 center, double radius);
};

}  // namespace pectora::view
