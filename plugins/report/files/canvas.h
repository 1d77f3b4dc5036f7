// A picture in memory: pixels to set, lines and text to draw (by Cairo), written as PNG.
#pragma once

#include "kernel/value/vec3.h"

#include <cairo.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace pectora {

struct Color {
  double r = 0, g = 0, b = 0;   ///< 0 to 1
};
constexpr Color kWhite{1, 1, 1}, kInk{0.13, 0.14, 0.17};

class Canvas {
 public:
  Canvas(int width, int height, Color background);
  int width() const { return width_; }
  int height() const { return height_; }
  void pixel(int x, int y, Color color);
  Color colorAt(int x, int y) const;   ///< of a pixel within the picture
  /// Grey values 0 to 255, row by row, scaled to a rectangle of the picture.
  void greyImage(const std::vector<unsigned char>& grey, int columns, int rows, double x, double y, double w, double h);
  void polyline(const std::vector<std::array<double, 2>>& points, bool closed, Color color, double lineWidth);
  void rectangle(double x, double y, double w, double h, Color color);
  /// `anchor` 0: x is the left end, 0.5: the middle, 1: the right end; y is the base line.
  void text(double x, double y, const std::string& words, double size, Color color, double anchor = 0);
  /// Writes the PNG aside and renames it. Throws Error.
  void write(const std::string& path);

 private:
  int width_, height_;
  std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface_;
  std::unique_ptr<cairo_t, void (*)(cairo_t*)> context_;
};

/// Blue for negative, grey for zero, red for positive; `value` and `limit` in the same unit.
Color divergingColor(double value, double limit);
/// A colour bar from -limit to +limit with ticks in mm.
void drawColorBar(Canvas& canvas, double x, double y, double w, double h, double limit, const std::string& title);

}  // namespace pectora
