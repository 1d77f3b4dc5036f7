// Triangle meshes and point clouds with named fields, and landmarks.
#pragma once

#include "kernel/value/value.h"
#include "kernel/value/vec3.h"

#include <array>

namespace pectora {

/// A named figure for every point of a mesh or cloud (a distance, a displacement).
struct PointField {
  std::string name;
  std::string unit;
  std::vector<double> values;  ///< one a point
};

/// A triangle mesh. Triangles run counter-clockwise seen from outside, so normals point out of the body.
struct Mesh : Value {
  static constexpr const char* kName = "Mesh";
  std::vector<Vec3> points;                    ///< LPS, mm
  std::vector<std::array<int, 3>> triangles;   ///< indices into points
  std::vector<PointField> fields;

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
};

/// A point cloud, as a hand-held scanner gives it.
struct Points : Value {
  static constexpr const char* kName = "Points";
  std::vector<Vec3> points;     ///< mm
  std::vector<Vec3> normals;    ///< unit, outward; empty if unknown
  std::vector<int> sweeps;      ///< which pass of the scanner saw the point; empty if unknown
  std::vector<PointField> fields;

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
};

struct Landmark {
  std::string name;  ///< "neck", "navel", "nipple_right", "nipple_left", or any other
  Vec3 position;     ///< mm
};

/// Named points on one surface.
struct Landmarks : Value {
  static constexpr const char* kName = "Landmarks";
  std::vector<Landmark> points;

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
  /// The landmark of that name, or nullptr.
  const Landmark* find(const std::string& name) const;
};

}  // namespace pectora
