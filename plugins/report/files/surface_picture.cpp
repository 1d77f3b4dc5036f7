#include "plugins/report/files/surface_picture.h"

#include "plugins/common/surface/point_normals.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr int kWidth = 900, kHeight = 760, kMargin = 60, kBarSpace = 150;

// Patient coordinates to pixels, seen from the front: x to the right, head up; smaller y is nearer.
struct FrontView {
  double scale = 1, centerX = 0, centerZ = 0;

  explicit FrontView(const std::vector<Vec3>& points) {
    Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
    for (const Vec3& p : points)
      for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
    if (points.empty()) return;
    scale = std::min((kWidth - 2 * kMargin - kBarSpace) / std::max(1.0, high.x - low.x),
                     (kHeight - 3 * kMargin) / std::max(1.0, high.z - low.z));
    centerX = 0.5 * (low.x + high.x);
    centerZ = 0.5 * (low.z + high.z);
  }
  Vec3 operator()(Vec3 p) const {
    return {(kWidth - kBarSpace) / 2.0 + (p.x - centerX) * scale, (kHeight - kMargin) / 2.0 - (p.z - centerZ) * scale, p.y};
  }
};

// A frame with a depth for each pixel.
struct DepthFrame {
  Canvas& canvas;
  std::vector<float> depth = std::vector<float>(std::size_t(kWidth) * kHeight, INFINITY);

  void plot(int x, int y, double d, Color color) {
    if (x < 0 || y < 0 || x >= kWidth || y >= kHeight || d >= depth[std::size_t(y) * kWidth + x]) return;
    depth[std::size_t(y) * kWidth + x] = float(d);
    canvas.pixel(x, y, color);
  }
};

Color shaded(Color c, Vec3 normal) {
  // Light from the front, a little from above and from the patient's right.
  const Vec3 light = normalized({-0.35, -0.85, 0.4});
  const double brightness = 0.45 + 0.6 * std::abs(dot(normal, light));
  return {c.r * brightness, c.g * brightness, c.b * brightness};
}

void drawTriangle(DepthFrame& frame, const FrontView& view, const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals,
                  const std::array<double, 3>& values, double limit) {
  const Vec3 a = view(corners[0]), b = view(corners[1]), c = view(corners[2]);
  const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (std::abs(area) < 1e-12) return;
  const int x0 = std::max(0, int(std::floor(std::min({a.x, b.x, c.x})))), x1 = std::min(kWidth - 1, int(std::ceil(std::max({a.x, b.x, c.x}))));
  const int y0 = std::max(0, int(std::floor(std::min({a.y, b.y, c.y})))), y1 = std::min(kHeight - 1, int(std::ceil(std::max({a.y, b.y, c.y}))));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const double px = x + 0.5, py = y + 0.5;
      const double u = ((b.x - px) * (c.y - py) - (b.y - py) * (c.x - px)) / area;
      const double v = ((c.x - px) * (a.y - py) - (c.y - py) * (a.x - px)) / area;
      const double w = 1 - u - v;
      if (u < -1e-9 || v < -1e-9 || w < -1e-9) continue;
      const Vec3 normal = normalized(normals[0] * u + normals[1] * v + normals[2] * w);
      const double value = values[0] * u + values[1] * v + values[2] * w;
      frame.plot(x, y, a.z * u + b.z * v + c.z * w, shaded(limit > 0 ? divergingColor(value, limit) : Color{0.86, 0.74, 0.66}, normal));
    }
  }
}

const std::vector<double>* findField(const std::vector<PointField>& fields, const std::string& name) {
  for (const PointField& f : fields)
    if (f.name == name) return &f.values;
  return nullptr;
}

}  // namespace

double roundLimit(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  for (double& v : values) v = std::abs(v);
  std::sort(values.begin(), values.end());
  const double wanted = values.empty() ? 1 : values[std::size_t(0.98 * double(values.size() - 1))];
  for (double limit : {0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 25.0, 30.0, 40.0, 50.0, 80.0})
    if (limit >= wanted) return limit;
  return 100;
}

Canvas surfacePicture(const Value& surface, const std::string& field, double limit, const std::string& title,
                      const std::vector<std::string>& caption) {
  Canvas canvas(kWidth, kHeight, kWhite);
  DepthFrame frame{canvas};
  if (const auto* mesh = dynamic_cast<const Mesh*>(&surface)) {
    const FrontView view(mesh->points);
    const std::vector<Vec3> normals = pointNormals(*mesh);
    const std::vector<double>* values = findField(mesh->fields, field);
    for (const auto& t : mesh->triangles) {
      std::array<double, 3> v{};
      if (values) v = {(*values)[t[0]], (*values)[t[1]], (*values)[t[2]]};
      drawTriangle(frame, view, {mesh->points[t[0]], mesh->points[t[1]], mesh->points[t[2]]},
                   {normals[t[0]], normals[t[1]], normals[t[2]]}, v, values ? limit : 0);
    }
  } else if (const auto* points = dynamic_cast<const Points*>(&surface)) {
    // Points without a value lie outside of what is compared: they are left out, and do not set the scale.
    const std::vector<double>* values = findField(points->fields, field);
    std::vector<Vec3> shown;
    for (std::size_t i = 0; i < points->points.size(); ++i)
      if (!values || std::isfinite((*values)[i])) shown.push_back(points->points[i]);
    const FrontView view(shown);
    for (std::size_t i = 0; i < points->points.size(); ++i) {
      if (values && !std::isfinite((*values)[i])) continue;
      const Vec3 p = view(points->points[i]);
      const Vec3 normal = points->normals.empty() ? Vec3{0, -1, 0} : points->normals[i];
      if (normal.y > 0.2) continue;  // seen from behind
      const Color color = shaded(values ? divergingColor((*values)[i], limit) : Color{0.86, 0.74, 0.66}, normal);
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) frame.plot(int(p.x) + dx, int(p.y) + dy, p.z, color);
    }
  }
  canvas.text(kMargin, 40, title, 20, kInk);
  canvas.text(kMargin, 62, "From the front; the patient's right is on the left", 12, kInk);
  for (std::size_t i = 0; i < caption.size(); ++i)
    canvas.text(kMargin, kHeight - 20 - 18.0 * double(caption.size() - 1 - i), caption[i], 13, kInk);
  if (limit > 0 && !field.empty()) drawColorBar(canvas, kWidth - kBarSpace + 20, 150, 26, 420, limit, "distance, mm");
  return canvas;
}

}  // namespace pectora
