#include "plugins/report/files/solid_view.h"

#include "kernel/value/curve.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr int kSides = 20;        // of a tube
constexpr int kOutlinePoints = 48;

// Rings of equal length joined to a closed surface; `rings` consecutive groups of `around` points.
void join(Mesh& mesh, int rings, int around) {
  for (int r = 0; r + 1 < rings; ++r)
    for (int i = 0; i < around; ++i) {
      const int a = r * around + i, b = r * around + (i + 1) % around;
      mesh.triangles.push_back({a, b, b + around});
      mesh.triangles.push_back({a, b + around, a + around});
    }
  for (int r : {0, rings - 1}) {
    Vec3 middle{};
    for (int i = 0; i < around; ++i) middle += mesh.points[r * around + i] / double(around);
    const int lid = int(mesh.points.size());
    mesh.points.push_back(middle);
    for (int i = 0; i < around; ++i) {
      const int a = r * around + i, b = r * around + (i + 1) % around;
      if (r == 0) mesh.triangles.push_back({lid, b, a});
      else mesh.triangles.push_back({lid, a, b});
    }
  }
}

}  // namespace

Mesh tubeMesh(const std::vector<Vec3>& line, double halfHigh, double halfThin, Vec3 axis) {
  Mesh mesh;
  if (line.size() < 2) return mesh;
  for (std::size_t n = 0; n < line.size(); ++n) {
    const Vec3 along = normalized(line[std::min(n + 1, line.size() - 1)] - line[n > 0 ? n - 1 : 0]);
    const Vec3 out{line[n].x - axis.x, line[n].y - axis.y, 0};
    const Vec3 thin = normalized(out - along * dot(out, along)), high = cross(along, thin);
    for (int i = 0; i < kSides; ++i) {
      const double a = 2 * M_PI * i / kSides;
      mesh.points.push_back(line[n] + thin * (halfThin * std::cos(a)) + high * (halfHigh * std::sin(a)));
    }
  }
  join(mesh, int(line.size()), kSides);
  return mesh;
}

Mesh stackMesh(const std::vector<std::vector<Vec3>>& outlines) {
  Mesh mesh;
  int rings = 0;
  for (const auto& outline : outlines) {
    if (outline.size() < 3) continue;
    // Every ring begins where it is farthest to the right of the patient, and runs around the same way.
    std::vector<Vec3> closed = outline;
    double area = 0;
    for (std::size_t n = 0; n < closed.size(); ++n) {
      const Vec3 a = closed[n], b = closed[(n + 1) % closed.size()];
      area += a.x * b.y - a.y * b.x;
    }
    if (area < 0) std::reverse(closed.begin(), closed.end());
    std::rotate(closed.begin(), std::min_element(closed.begin(), closed.end(), [](Vec3 a, Vec3 b) { return a.x < b.x; }), closed.end());
    closed.push_back(closed.front());
    closed = resamplePolyline(closed, kOutlinePoints + 1);
    mesh.points.insert(mesh.points.end(), closed.begin(), closed.end() - 1);
    ++rings;
  }
  if (rings < 2) return {};
  join(mesh, rings, kOutlinePoints);
  return mesh;
}

SolidView::SolidView(Seen from, int x, int y, int width, int height, Vec3 center, double pixelsPerMm)
    : from_(from), x_(x), y_(y), width_(width), height_(height), center_(center), scale_(pixelsPerMm),
      depth_(std::size_t(width) * height * kSamples * kSamples, INFINITY), color_(depth_.size()) {}

Vec3 SolidView::project(Vec3 p) const {
  const double across = from_ == Seen::fromFront ? p.x - center_.x : p.y - center_.y;
  const double depth = from_ == Seen::fromFront ? p.y - center_.y : center_.x - p.x;
  return {kSamples * (0.5 * width_ + across * scale_), kSamples * (0.5 * height_ - (p.z - center_.z) * scale_), depth};
}

std::array<double, 2> SolidView::at(Vec3 p) const {
  const Vec3 q = project(p);
  return {x_ + q.x / kSamples, y_ + q.y / kSamples};
}

void SolidView::draw(const Mesh& mesh, Color color) {
  std::vector<Vec3> normals(mesh.points.size());
  for (const auto& t : mesh.triangles) {
    const Vec3 n = cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
    for (int corner : t) normals[corner] += n;
  }
  // Light from over the viewer's left shoulder.
  const Vec3 light = from_ == Seen::fromFront ? normalized({-0.4, -1, 0.6}) : normalized({0.9, -0.5, 0.6});
  const int wide = kSamples * width_, tall = kSamples * height_;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = project(mesh.points[t[0]]), b = project(mesh.points[t[1]]), c = project(mesh.points[t[2]]);
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (std::abs(area) < 1e-12) continue;
    const int x0 = std::max(0, int(std::floor(std::min({a.x, b.x, c.x})))), x1 = std::min(wide - 1, int(std::ceil(std::max({a.x, b.x, c.x}))));
    const int y0 = std::max(0, int(std::floor(std::min({a.y, b.y, c.y})))), y1 = std::min(tall - 1, int(std::ceil(std::max({a.y, b.y, c.y}))));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const double px = x + 0.5, py = y + 0.5;
        const double u = ((b.x - px) * (c.y - py) - (b.y - py) * (c.x - px)) / area;
        const double v = ((c.x - px) * (a.y - py) - (c.y - py) * (a.x - px)) / area, w = 1 - u - v;
        if (u < -1e-9 || v < -1e-9 || w < -1e-9) continue;
        const double depth = a.z * u + b.z * v + c.z * w;
        const std::size_t at = std::size_t(y) * wide + x;
        if (depth >= depth_[at]) continue;
        depth_[at] = float(depth);
        // The side that is seen is lit, whichever way the mesh is wound.
        Vec3 normal = normalized(normals[t[0]] * u + normals[t[1]] * v + normals[t[2]] * w);
        if ((from_ == Seen::fromFront ? normal.y : -normal.x) > 0) normal = -normal;
        const double shade = 0.42 + 0.6 * std::max(0.0, dot(normal, light));
        color_[at] = {color.r * shade, color.g * shade, color.b * shade};
      }
  }
}

void SolidView::paint(Canvas& canvas) const {
  const int wide = kSamples * width_;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      Color sum;
      int covered = 0;
      for (int j = 0; j < kSamples; ++j)
        for (int i = 0; i < kSamples; ++i) {
          const std::size_t at = std::size_t(y * kSamples + j) * wide + x * kSamples + i;
          const bool isEmpty = std::isinf(depth_[at]);
          covered += !isEmpty;
          const Color c = isEmpty ? kWhite : color_[at];
          sum.r += c.r, sum.g += c.g, sum.b += c.b;
        }
      constexpr double share = 1.0 / (kSamples * kSamples);
      if (covered > 0) canvas.pixel(x_ + x, y_ + y, {sum.r * share, sum.g * share, sum.b * share});
    }
}

}  // namespace pectora
