// Solids seen in parallel projection: a small rasteriser with depth, light and four samples a pixel.
#pragma once

#include "plugins/report/files/canvas.h"

#include "kernel/value/mesh.h"

namespace pectora {

/// From where one looks. Up is the head in both.
enum class Seen { fromFront, fromLeft };

/// A tube of elliptic section along a line: `halfHigh` along the body's axis, `halfThin` away from `axis`, the chest's middle.
/// Closed at both ends. Empty for fewer than two points.
Mesh tubeMesh(const std::vector<Vec3>& line, double halfHigh, double halfThin, Vec3 axis);
/// The solid between closed outlines, one above the other, with lids at both ends. Empty for fewer than two outlines.
Mesh stackMesh(const std::vector<std::vector<Vec3>>& outlines);

/// A rectangle of the canvas with the view of some solids.
class SolidView {
 public:
  /// `center` comes to the middle of the rectangle (its left upper corner at x, y).
  SolidView(Seen from, int x, int y, int width, int height, Vec3 center, double pixelsPerMm);
  /// Draws a closed mesh, shaded by its own faces' smoothed normals; what is nearer hides what is farther.
  void draw(const Mesh& mesh, Color color);
  /// Where a point comes to lie on the canvas.
  std::array<double, 2> at(Vec3 p) const;
  /// Copies what was drawn onto the canvas; where nothing was drawn it stays as it is.
  void paint(Canvas& canvas) const;

 private:
  static constexpr int kSamples = 2;   // along x and along y in every pixel
  Vec3 project(Vec3 p) const;          // samples and depth
  Seen from_;
  int x_, y_, width_, height_;
  Vec3 center_;
  double scale_;
  std::vector<float> depth_;
  std::vector<Color> color_;
};

}  // namespace pectora
