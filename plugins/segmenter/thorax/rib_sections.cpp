#include "plugins/segmenter/thorax/rib_sections.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pectora::thorax {
namespace {

constexpr double kAxisBeforeSpineMm = 30;
constexpr double kPixelMm = 1.0;
constexpr double kNearestMm = 20, kFarthestMm = 230;

}  // namespace

Vec3 Fan::axisAt(double z) const {
  const double k = std::clamp(z / sliceSpacing, 0.0, double(axis.size() - 1));
  const std::size_t low = std::min(std::size_t(k), axis.size() - std::min<std::size_t>(axis.size(), 2));
  const std::size_t high = std::min(low + 1, axis.size() - 1);
  return lerp(axis[low], axis[high], k - double(low));
}

Vec3 Fan::position(double degrees, Point2 p) const {
  const double a = degrees * std::numbers::pi / 180;
  const Vec3 o = axisAt(p.y);
  return {o.x + (side == Side::right ? -1 : 1) * p.x * std::sin(a), o.y - p.x * std::cos(a), p.y};
}

Fan makeFan(Side side, const Spine& spine, Vec3 spacing) {
  Fan fan{side, spine.front, spacing.z};
  for (Vec3& p : fan.axis) p.y -= kAxisBeforeSpineMm;
  return fan;
}

std::vector<std::vector<Section>> findSections(const Fan& fan, const Field& field, const SectionLimits& limits) {
  const Box& box = field.box();
  const double bottom = box.low[2] * field.spacing().z, top = (box.high[2] - 1) * field.spacing().z;
  const int height = int((top - bottom) / kPixelMm) + 1, width = int((kFarthestMm - kNearestMm) / kPixelMm);
  std::vector<std::vector<Section>> result(Fan::kLast - Fan::kFirst + 1);
  parallelFor(result.size(), [&](std::size_t n) {
    const double degrees = Fan::kFirst + double(n);
    Plane plane(width, height);
    for (int j = 0; j < height; ++j) {
      const double z = bottom + j * kPixelMm;
      for (int i = 0; i < width; ++i) {
        const Vec3 p = fan.position(degrees, {kNearestMm + i * kPixelMm, z});
        plane.at(i, j) = field.contains(p) ? field.at(p) : -1024.0f;
      }
    }
    for (Loop& loop : isoContours(plane, float(limits.boneHu))) {
      for (Point2& p : loop) p = {kNearestMm + p.x * kPixelMm, bottom + p.y * kPixelMm};
      const Shape shape = shapeOf(loop);
      if (shape.area < limits.leastAreaMm2 || shape.area > limits.mostAreaMm2 ||
          shape.spreadMajor > limits.mostSpreadMm)
        continue;
      result[n].push_back({std::move(loop), shape});
    }
  });
  return result;
}

}  // namespace pectora::thorax
