// Chest-like height fields with a distance that is known in closed form.
#pragma once

#include "kernel/value/mesh.h"

#include <cstdint>
#include <random>

namespace pectora::bench {

/// A chest with a pit: y of the skin and its outward normal (here towards +y).
inline Vec3 chestPoint(double x, double z, Vec3* normal = nullptr) {
  const double pit = 25 * std::exp(-(x * x + z * z) / (2 * 35.0 * 35));
  if (normal) *normal = normalized({120 * x / (170.0 * 170) - pit * x / (35.0 * 35), 1, -pit * z / (35.0 * 35)});
  return {x, 60 * (1 - x * x / (170.0 * 170)) - pit, z};
}

/// The distance of the compared surface from the chest, mm.
inline double trueDistance(double x, double z) { return 4 * std::sin(x / 40) * std::cos(z / 50) + 0.5; }

/// n x n points over +-halfX by +-halfZ, shifted by (dx, dz); `place` gives the point for (x, z). Normals point to +y.
template <class Place>
Mesh heightField(int n, double halfX, double halfZ, double dx, double dz, const Place& place) {
  Mesh mesh;
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) {
      // Rounded to float, as the files that the other programs read hold them.
      const Vec3 p = place(dx - halfX + 2 * halfX * c / (n - 1), dz - halfZ + 2 * halfZ * r / (n - 1));
      mesh.points.push_back({double(float(p.x)), double(float(p.y)), double(float(p.z))});
    }
  for (int r = 0; r + 1 < n; ++r)
    for (int c = 0; c + 1 < n; ++c) {
      const int a = r * n + c;
      mesh.triangles.push_back({a, a + n, a + 1});
      mesh.triangles.push_back({a + 1, a + n, a + n + 1});
    }
  return mesh;
}

inline Mesh reference(int n) {
  return heightField(n, 140, 180, 0, 0, [](double x, double z) { return chestPoint(x, z); });
}

inline Mesh compared(int n) {
  return heightField(n, 128, 168, 0.137, 0.211, [](double x, double z) {
    Vec3 normal;
    const Vec3 p = chestPoint(x, z, &normal);
    return p + normal * trueDistance(x, z);
  });
}

/// The chest with noise along its normal, turned by 5 degrees about (1, 2, -1) and shifted by 7.8 mm.
inline Vec3 displace(Vec3 p) {
  const double angle = 5 * 3.14159265358979323846 / 180, c = std::cos(angle), s = std::sin(angle);
  const Vec3 axis = normalized({1, 2, -1});
  return p * c + cross(axis, p) * s + axis * (dot(axis, p) * (1 - c)) + Vec3{6, -4, 3};
}
inline Mesh displaced(int n, double noise, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normalNoise(0, noise);
  return heightField(n, 128, 168, 0.137, 0.211, [&](double x, double z) {
    Vec3 normal;
    const Vec3 p = chestPoint(x, z, &normal);
    return displace(p + normal * normalNoise(random));
  });
}

}  // namespace pectora::bench
