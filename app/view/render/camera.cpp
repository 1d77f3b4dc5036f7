#include "app/view/render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pectora::view {
namespace {

const double kTanHalfAngle = std::tan(14 * std::numbers::pi / 180);   // half of the vertical angle of view

}  // namespace

Vec3 Camera::eye() const {
  return target + Vec3{std::sin(yaw) * std::cos(pitch), -std::cos(yaw) * std::cos(pitch), std::sin(pitch)} * distance;
}
Vec3 Camera::right() const { return {std::cos(yaw), std::sin(yaw), 0}; }
Vec3 Camera::up() const { return cross(right(), normalized(target - eye())); }

Matrix4 Camera::matrix() const {
  const Vec3 e = eye(), r = right(), u = up(), f = normalized(target - e);
  const double near = std::max(1.0, distance - 1200), far = distance + 1200;
  const double sx = 1 / (kTanHalfAngle * aspect), sy = 1 / kTanHalfAngle, a = (far + near) / (far - near), b = -2 * far * near / (far - near);
  const auto row = [&](Vec3 d, double s) { return std::array<double, 4>{d.x * s, d.y * s, d.z * s, -dot(d, e) * s}; };
  const auto x = row(r, sx), y = row(u, sy), z = row(f, a), w = row(f, 1);
  Matrix4 m{};
  for (int c = 0; c < 4; ++c) {
    m[c * 4 + 0] = float(x[c]);
    m[c * 4 + 1] = float(y[c]);
    m[c * 4 + 2] = float(z[c] + (c == 3 ? b : 0));
    m[c * 4 + 3] = float(w[c]);
  }
  return m;
}

Ray Camera::ray(double x, double y) const {
  const Vec3 e = eye(), f = normalized(target - e);
  return {e, normalized(f + right() * ((2 * x - 1) * kTanHalfAngle * aspect) + up() * ((1 - 2 * y) * kTanHalfAngle))};
}

Vec3 Camera::onPlane(Vec3 through, double x, double y) const {
  const Ray r = ray(x, y);
  const Vec3 forward = normalized(target - eye());
  return r.origin + r.direction * (dot(through - r.origin, forward) / dot(r.direction, forward));
}

Vec3 Camera::project(Vec3 point) const {
  const Vec3 d = point - eye();
  const double depth = dot(d, normalized(target - eye()));
  const double s = depth * kTanHalfAngle;
  return {0.5 + 0.5 * dot(d, right()) / (s * aspect), 0.5 - 0.5 * dot(d, up()) / s, depth};
}

void Camera::orbit(double dx, double dy) {
  yaw -= 3.5 * dx;
  pitch = std::clamp(pitch + 3.5 * dy, -1.55, 1.55);
}

void Camera::pan(double dx, double dy) {
  const double mm = 2 * kTanHalfAngle * distance;   // that the picture's height shows there
  target += right() * (-dx * mm) + up() * (dy * mm);
}

void Camera::zoom(double factor) { distance = std::clamp(distance * factor, 60.0, 5000.0); }

void Camera::frame(Vec3 center, double radius) {
  target = center;
  distance = 1.05 * radius / (kTanHalfAngle * std::min(1.0, aspect));
}

}  // namespace pectora::view
