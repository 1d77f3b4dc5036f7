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

constexpr double kSplitSpreadMm = 6.5, kSplitDistanceMm = 11, kSplitAreaMm2 = 20;

/// Contours of a plane in its coordinates, outer ones only.
std::vector<Section> sectionsAt(const Plane& plane, double level, double bottom) {
  std::vector<Section> sections;
  for (Loop& loop : isoContours(plane, float(level))) {
    for (Point2& p : loop) p = {kNearestMm + p.x * kPixelMm, bottom + p.y * kPixelMm};
    const Shape shape = shapeOf(loop);
    if (shape.area > 0) sections.push_back({std::move(loop), shape});
  }
  return sections;
}

/// Two ribs that touch, or that thick slices have run together, come apart at a higher level: the parts of `section`
/// at the lowest level that leaves at least two, one above the other. Empty if there is no such level.
std::vector<Section> split(const Section& section, const std::vector<std::vector<Section>>& higher) {
  for (const std::vector<Section>& level : higher) {
    std::vector<Section> parts;
    for (const Section& part : level)
      if (part.shape.area >= kSplitAreaMm2 && isInside(section.contour, part.contour.front())) parts.push_back(part);
    if (parts.size() < 2) continue;
    std::sort(parts.begin(), parts.end(), [](const Section& a, const Section& b) { return a.shape.centroid.y < b.shape.centroid.y; });
    bool isStacked = true;
    for (std::size_t n = 1; n < parts.size(); ++n)
      isStacked = isStacked && parts[n].shape.centroid.y - parts[n - 1].shape.centroid.y > kSplitDistanceMm;
    if (isStacked) return parts;
  }
  return {};
}

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
    std::vector<std::vector<Section>> higher;
    for (Section& section : sectionsAt(plane, limits.boneHu, bottom)) {
      std::vector<Section> parts;
      if (section.shape.spreadMajor > kSplitSpreadMm) {
        if (higher.empty())
          for (double factor : {1.4, 1.9, 2.6, 3.5}) higher.push_back(sectionsAt(plane, factor * limits.boneHu, bottom));
        parts = split(section, higher);
      }
      if (parts.empty()) parts.push_back(std::move(section));
      for (Section& part : parts)
        if (part.shape.area >= limits.leastAreaMm2 && part.shape.area <= limits.mostAreaMm2 &&
            part.shape.spreadMajor <= limits.mostSpreadMm)
          result[n].push_back(std::move(part));
    }
  });
  return result;
}

}  // namespace pectora::thorax
