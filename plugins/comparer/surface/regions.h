// Parts of a surface that somebody names.
#pragma once

#include "kernel/value/vec3.h"

#include <string>

namespace pectora {

/// A ball or a box, in the reference's coordinates.
struct Region {
  std::string name;
  bool isBall = true;
  Vec3 low, high;        ///< of a box, mm
  Vec3 center;           ///< of a ball, mm
  double radius = 0;     ///< of a ball, mm

  bool contains(Vec3 p) const;
};

/// Reads "NAME = ball X Y Z RADIUS" or "NAME = box X0 X1 Y0 Y1 Z0 Z1", mm. Throws Error that says what is wrong.
Region parseRegion(const std::string& text);

}  // namespace pectora
