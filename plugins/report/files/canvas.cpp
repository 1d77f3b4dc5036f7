#include "plugins/report/files/canvas.h"

#include "plugins/report/common/atomic_file.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {

Canvas::Canvas(int width, int height, Color background)
    : width_(width), height_(height),
      surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), cairo_surface_destroy),
      context_(cairo_create(surface_.get()), cairo_destroy) {
  rectangle(0, 0, width, height, background);
  cairo_select_font_face(context_.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
}

void Canvas::pixel(int x, int y, Color c) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  cairo_surface_flush(surface_.get());
  auto* row = reinterpret_cast<std::uint32_t*>(cairo_image_surface_get_data(surface_.get()) +
                                               std::size_t(y) * cairo_image_surface_get_stride(surface_.get()));
  const auto byte = [](double v) { return std::uint32_t(std::lround(255 * std::clamp(v, 0.0, 1.0))); };
  row[x] = byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b);
  cairo_surface_mark_dirty(surface_.get());
}

Color Canvas::colorAt(int x, int y) const {
  cairo_surface_flush(surface_.get());
  const auto* row = reinterpret_cast<const std::uint32_t*>(cairo_image_surface_get_data(surface_.get()) +
                                                           std::size_t(y) * cairo_image_surface_get_stride(surface_.get()));
  return {(row[x] >> 16 & 255) / 255.0, (row[x] >> 8 & 255) / 255.0, (row[x] & 255) / 255.0};
}

void Canvas::greyImage(const std::vector<unsigned char>& grey, int columns, int rows, double x, double y, double w, double h) {
  cairo_surface_t* image = cairo_image_surface_create(CAIRO_FORMAT_RGB24, columns, rows);
  for (int r = 0; r < rows; ++r) {
    auto* row = reinterpret_cast<std::uint32_t*>(cairo_image_surface_get_data(image) +
                                                 std::size_t(r) * cairo_image_surface_get_stride(image));
    for (int c = 0; c < columns; ++c) row[c] = 0x010101u * grey[std::size_t(r) * columns + c];
  }
  cairo_surface_mark_dirty(image);
  cairo_save(context_.get());
  cairo_translate(context_.get(), x, y);
  cairo_scale(context_.get(), w / columns, h / rows);
  cairo_set_source_surface(context_.get(), image, 0, 0);
  cairo_paint(context_.get());
  cairo_restore(context_.get());
  cairo_surface_destroy(image);
}

void Canvas::polyline(const std::vector<std::array<double, 2>>& points, bool closed, Color c, double lineWidth) {
  if (points.size() < 2) return;
  cairo_set_source_rgb(context_.get(), c.r, c.g, c.b);
  cairo_set_line_width(context_.get(), lineWidth);
  cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(context_.get(), CAIRO_LINE_CAP_ROUND);
  cairo_move_to(context_.get(), points[0][0], points[0][1]);
  for (std::size_t i = 1; i < points.size(); ++i) cairo_line_to(context_.get(), points[i][0], points[i][1]);
  if (closed) cairo_close_path(context_.get());
  cairo_stroke(context_.get());
}

void Canvas::rectangle(double x, double y, double w, double h, Color c) {
  cairo_set_source_rgb(context_.get(), c.r, c.g, c.b);
  cairo_rectangle(context_.get(), x, y, w, h);
  cairo_fill(context_.get());
}

void Canvas::text(double x, double y, const std::string& words, double size, Color c, double anchor) {
  cairo_set_source_rgb(context_.get(), c.r, c.g, c.b);
  cairo_set_font_size(context_.get(), size);
  cairo_text_extents_t extents;
  cairo_text_extents(context_.get(), words.c_str(), &extents);
  cairo_move_to(context_.get(), x - anchor * extents.x_advance, y);
  cairo_show_text(context_.get(), words.c_str());
}

void Canvas::write(const std::string& path) {
  cairo_surface_flush(surface_.get());
  const cairo_status_t status = cairo_surface_write_to_png(surface_.get(), asideName(path).c_str());
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error(std::string("the picture cannot be written: ") + cairo_status_to_string(status), ErrorKind::runFailed).at(path);
  publish(path);
}

Color divergingColor(double value, double limit) {
  if (!std::isfinite(value)) return {0.55, 0.55, 0.55};
  const double t = std::clamp(value / limit, -1.0, 1.0);
  const Color middle{0.93, 0.93, 0.92};
  const Color end = t < 0 ? Color{0.13, 0.35, 0.71} : Color{0.72, 0.11, 0.15};
  const double s = std::abs(t);
  return {std::lerp(middle.r, end.r, s), std::lerp(middle.g, end.g, s), std::lerp(middle.b, end.b, s)};
}

void drawColorBar(Canvas& canvas, double x, double y, double w, double h, double limit, const std::string& title) {
  const int steps = 200;
  for (int i = 0; i < steps; ++i)
    canvas.rectangle(x, y + h * i / steps, w, h / steps + 1, divergingColor(limit * (1 - 2 * (i + 0.5) / steps), limit));
  for (int tick = -2; tick <= 2; ++tick) {
    const double at = y + h * (0.5 - tick / 4.0);
    canvas.rectangle(x + w, at - 0.5, 5, 1, kInk);
    canvas.text(x + w + 9, at + 5, fmt::format("{:+.3g}", limit * tick / 2), 14, kInk);
  }
  canvas.text(x, y - 14, title, 14, kInk);
}

}  // namespace pectora
