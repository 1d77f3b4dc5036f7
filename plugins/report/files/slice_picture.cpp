#include "plugins/report/files/slice_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr double kWindowLevel = 40, kWindowWidth = 400;
constexpr double kPixelsPerMm = 2.2;
constexpr int kLegend = 46;
constexpr double kRingMm = 5;   // about a cartilage's line

struct Structure {
  const char* name;
  Color color;
};
constexpr Structure kStructures[] = {{"skin", {0.20, 0.83, 0.88}},  {"pleura", {0.40, 0.90, 0.40}}, {"rib", {1.0, 0.76, 0.20}},
                                     {"sternum", {0.96, 0.36, 0.36}}, {"vertebra", {0.72, 0.56, 1.0}}, {"scapula", {0.95, 0.55, 0.85}},
                                     {"cartilage", {0.55, 0.75, 1.0}}};

Color colorOf(const std::string& structure) {
  for (const Structure& s : kStructures)
    if (structure == s.name) return s.color;
  return {0.7, 0.7, 0.7};
}

}  // namespace

Canvas slicePicture(const Volume& ct, const Anatomy& anatomy, const RibCage* cage, int slice) {
  const Grid& grid = ct.grid;
  const double scaleX = grid.spacing.x * kPixelsPerMm, scaleY = grid.spacing.y * kPixelsPerMm;
  const int width = int(std::lround(grid.size[0] * scaleX)), height = int(std::lround(grid.size[1] * scaleY));
  Canvas canvas(width, height + kLegend, kInk);

  std::vector<unsigned char> grey(grid.sliceVoxels());
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const double hu = ct.hu[slice * grid.sliceVoxels() + i];
    grey[i] = (unsigned char)(255 * std::clamp((hu - kWindowLevel) / kWindowWidth + 0.5, 0.0, 1.0));
  }
  canvas.greyImage(grey, grid.size[0], grid.size[1], 0, 0, width, height);

  // Voxel centres lie in the middle of their squares.
  const auto toPixel = [&](Vec3 p) {
    const Vec3 v = grid.toVoxel(p);
    return std::array<double, 2>{(v.x + 0.5) * scaleX, (v.y + 0.5) * scaleY};
  };
  for (const SliceContour& contour : anatomy.contours) {
    if (contour.slice != slice || contour.points.empty()) continue;
    std::vector<std::array<double, 2>> line;
    double x = 0, y = 0;
    for (const Vec3& p : contour.points) {
      line.push_back(toPixel(p));
      x += line.back()[0];
      y += line.back()[1];
    }
    canvas.polyline(line, contour.closed, colorOf(contour.structure), 1.6);
    if (contour.number > 0) {
      const double n = double(line.size());
      canvas.text(x / n + 9, y / n - 9, fmt::format("{}{}", contour.side == Side::right ? "R" : "L", contour.number), 13, colorOf(contour.structure));
    }
  }
  // Cartilages where their line crosses the slice.
  for (std::size_t n = 0; cage && n < cage->cartilages.size(); ++n) {
    const Cartilage& cartilage = cage->cartilages[n];
    const std::vector<Vec3> line = cartilage.curve.sample(80);
    for (std::size_t i = 1; i < line.size(); ++i) {
      const double a = grid.toVoxel(line[i - 1]).z - slice, b = grid.toVoxel(line[i]).z - slice;
      if ((a < 0) == (b < 0)) continue;
      const auto middle = toPixel(lerp(line[i - 1], line[i], a / (a - b)));
      std::vector<std::array<double, 2>> ring;
      for (int d = 0; d < 24; ++d) ring.push_back({middle[0] + kRingMm * kPixelsPerMm * std::cos(d * M_PI / 12), middle[1] + kRingMm * kPixelsPerMm * std::sin(d * M_PI / 12)});
      canvas.polyline(ring, true, colorOf("cartilage"), 1.4);
      canvas.text(middle[0], middle[1] - kRingMm * kPixelsPerMm - 3, fmt::format("{}{}", cartilage.side == Side::right ? "R" : "L", cartilage.rib), 12, colorOf("cartilage"), 0.5);
    }
  }
  double at = 12;
  for (const Structure& s : kStructures) {
    canvas.rectangle(at, height + 16, 14, 14, s.color);
    canvas.text(at + 20, height + 28, s.name, 14, kWhite);
    at += 106;
  }
  canvas.text(width - 12, 24, fmt::format("slice {}  z = {:.1f} mm", slice, grid.toPatient({0, 0, double(slice)}).z), 15, kWhite, 1);
  canvas.text(12, 24, "R", 16, kWhite);
  return canvas;
}

}  // namespace pectora
