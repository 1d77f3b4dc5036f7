// A point or direction in space. Positions are DICOM patient coordinates in mm:
// x towards the patient's left, y towards the back, z towards the head (LPS).
#pragma once

#include <cmath>

namespace pectora {

struct Vec3 {
  double x = 0, y = 0, z = 0;

  constexpr double& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr Vec3& operator+=(Vec3 b) { x += b.x, y += b.y, z += b.z; return *this; }
  constexpr Vec3& operator-=(Vec3 b) { x -= b.x, y -= b.y, z -= b.z; return *this; }
  constexpr Vec3& operator*=(double s) { x *= s, y *= s, z *= s; return *this; }
  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return a += b; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return a -= b; }
  friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(Vec3 a, double s) { return a *= s; }
  friend constexpr Vec3 operator*(double s, Vec3 a) { return a *= s; }
  friend constexpr Vec3 operator/(Vec3 a, double s) { return a *= 1 / s; }
  friend constexpr bool operator==(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
};

constexpr double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(Vec3 a) { return std::sqrt(dot(a, a)); }
inline double distance(Vec3 a, Vec3 b) { return norm(a - b); }
/// The unit vector along `a`; the zero vector stays zero.
inline Vec3 normalized(Vec3 a) {
  const double length = norm(a);
  return length > 0 ? a / length : a;
}
constexpr Vec3 lerp(Vec3 a, Vec3 b, double t) { return a + (b - a) * t; }
inline bool isFinite(Vec3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

}  // namespace pectora
