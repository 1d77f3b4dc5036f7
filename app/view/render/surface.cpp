#include "app/view/render/surface.h"

#include "kernel/value/curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pectora::view {

void Surface::computeNormals() {
  if (triangles.empty()) return;
  normals.assign(points.size(), {});
  for (const auto& t : triangles) {
    const Vec3 n = cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
    for (int corner : t) normals[corner] += n;
  }
  for (Vec3& n : normals) n = normalized(n);
}

void Surface::append(const Surface& other) {
  const int base = int(points.size());
  points.insert(points.end(), other.points.begin(), other.points.end());
  normals.insert(normals.end(), other.normals.begin(), other.normals.end());
  values.insert(values.end(), other.values.begin(), other.values.end());
  for (const auto& t : other.triangles) triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

namespace {

// Joins ring after ring of equal size with triangles.
void joinRings(Surface& s, int rings, int size) {
  for (int r = 0; r + 1 < rings; ++r)
    for (int i = 0; i < size; ++i) {
      const int a = r * size + i, b = r * size + (i + 1) % size, c = a + size, d = b + size;
      s.triangles.push_back({a, b, d});
      s.triangles.push_back({a, d, c});
    }
}

// Closes a ring with a point of its own in the middle.
void closeRing(Surface& s, int first, int size, bool isEnd) {
  Vec3 middle;
  for (int i = 0; i < size; ++i) middle += s.points[first + i] / double(size);
  const int centre = int(s.points.size());
  s.points.push_back(middle);
  for (int i = 0; i < size; ++i) {
    const int a = first + i, b = first + (i + 1) % size;
    if (isEnd) s.triangles.push_back({centre, a, b});
    else s.triangles.push_back({centre, b, a});
  }
}

Vec3 tangent(std::span<const Vec3> line, std::size_t i) {
  return normalized(line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0]);
}

}  // namespace

Surface tube(std::span<const Vec3> line, double radius, int sides) {
  Surface s;
  if (line.size() < 2) return s;
  // A frame that is carried along without twist.
  const Vec3 first = tangent(line, 0);
  Vec3 across = normalized(cross(first, std::abs(first.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}));
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec3 along = tangent(line, i);
    across = normalized(across - along * dot(across, along));
    const Vec3 other = cross(along, across);
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      s.points.push_back(line[i] + (across * std::cos(angle) + other * std::sin(angle)) * radius);
    }
  }
  joinRings(s, int(line.size()), sides);
  closeRing(s, 0, sides, false);
  closeRing(s, int(line.size() - 1) * sides, sides, true);
  s.computeNormals();
  return s;
}

Surface loft(const std::vector<std::vector<Vec3>>& contours) {
  constexpr int kSize = 40;
  Surface s;
  int rings = 0;
  for (const auto& contour : contours) {
    if (contour.size() < 3) continue;
    // Equal angles about the middle, the farthest point of each: contours of one bone then match.
    Vec3 middle;
    for (const Vec3& p : contour) middle += p / double(contour.size());
    std::vector<Vec3> closed(contour);
    closed.push_back(contour.front());
    const std::vector<Vec3> dense = resamplePolyline(closed, 240);
    for (int k = 0; k < kSize; ++k) {
      const double angle = 2 * std::numbers::pi * k / kSize;
      const Vec3 direction{std::cos(angle), std::sin(angle), 0};
      Vec3 best = middle;
      double nearest = -2;
      for (const Vec3& p : dense)
        if (const double c = dot(normalized(p - middle), direction); c > nearest) nearest = c, best = p;
      s.points.push_back(best);
    }
    ++rings;
  }
  if (rings < 2) return {};
  joinRings(s, rings, kSize);
  closeRing(s, 0, kSize, false);
  closeRing(s, (rings - 1) * kSize, kSize, true);
  s.computeNormals();
  return s;
}

Surface sweptBar(std::span<const Vec3> line, Vec3 up, double width, double height) {
  Surface s;
  if (line.size() < 2) return s;
  // Four faces, each with points of its own so that the edges stay sharp.
  for (int face = 0; face < 4; ++face) {
    const int base = int(s.points.size());
    for (std::size_t i = 0; i < line.size(); ++i) {
      const Vec3 out = normalized(cross(tangent(line, i), up)) * (height / 2), across = up * (width / 2);
      const Vec3 corners[4] = {out + across, out - across, -out - across, -out + across};
      s.points.push_back(line[i] + corners[face]);
      s.points.push_back(line[i] + corners[(face + 1) % 4]);
    }
    for (int i = 0; i + 1 < int(line.size()); ++i) {
      const int a = base + 2 * i;
      s.triangles.push_back({a, a + 1, a + 3});
      s.triangles.push_back({a, a + 3, a + 2});
    }
  }
  s.computeNormals();
  return s;
}

Surface ball(Vec3 center, double radius) {
  constexpr int kRings = 10, kSides = 16;
  Surface s;
  for (int r = 0; r <= kRings; ++r)
    for (int k = 0; k < kSides; ++k) {
      const double a = std::numbers::pi * r / kRings, b = 2 * std::numbers::pi * k / kSides;
      s.points.push_back(center + Vec3{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), -std::cos(a)} * radius);
    }
  joinRings(s, kRings + 1, kSides);
  for (const Vec3& p : s.points) s.normals.push_back(normalized(p - center));
  return s;
}

double pointSpacing(std::span<const Vec3> points) {
  if (points.empty()) return 0;
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points)
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  const double side = norm(high - low) / 100;
  if (side == 0) return 0;
  // Of boxes so large, those with a point in them: a surface fills about 1.25 of a side's square in each that it meets.
  std::vector<std::uint32_t> boxes;
  boxes.reserve(points.size());
  for (const Vec3& p : points) {
    std::uint32_t box = 0;
    for (int a = 0; a < 3; ++a) box = box * 128 + std::uint32_t((p[a] - low[a]) / side);
    boxes.push_back(box);
  }
  std::sort(boxes.begin(), boxes.end());
  const auto met = std::unique(boxes.begin(), boxes.end()) - boxes.begin();
  return side * std::sqrt(1.25 * double(met) / double(points.size()));
}

std::optional<Hit> pick(const Surface& surface, const Ray& ray) {
  std::optional<Hit> best;
  // Moeller and Trumbore 1997.
  for (const auto& t : surface.triangles) {
    const Vec3 a = surface.points[t[0]], e1 = surface.points[t[1]] - a, e2 = surface.points[t[2]] - a;
    const Vec3 p = cross(ray.direction, e2);
    const double det = dot(e1, p);
    if (std::abs(det) < 1e-12) continue;
    const Vec3 s = ray.origin - a;
    const double u = dot(s, p) / det;
    if (u < 0 || u > 1) continue;
    const Vec3 q = cross(s, e1);
    const double v = dot(ray.direction, q) / det;
    if (v < 0 || u + v > 1) continue;
    const double along = dot(e2, q) / det;
    if (along <= 0 || (best && along >= best->distance)) continue;
    best = Hit{ray.origin + ray.direction * along, along, u + v < 0.5 ? t[0] : u > v ? t[1] : t[2]};
  }
  if (!surface.triangles.empty()) return best;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const Vec3 d = surface.points[i] - ray.origin;
    const double along = dot(d, ray.direction);
    if (along <= 0 || (best && along > best->distance) || norm(d - ray.direction * along) > 3) continue;
    best = Hit{surface.points[i], along, int(i)};
  }
  return best;
}

}  // namespace pectora::view
