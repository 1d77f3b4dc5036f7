#include "app/view/platform/target.h"

#include "kernel/stage/error.h"

#include <cairo.h>

#include <malloc.h>

#include <algorithm>

namespace pectora::view {

Target::Target() {
  // A renderer in software asks for its memory anew with every frame. Given back to the system in between, the pages it comes from would
  // have to be made again, which takes a third of the frame.
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
}

std::vector<unsigned char> Target::pixels() const {
  const auto [width, height] = size();
  return readPixels(readFramebuffer(), width, height);
}

void writePng(const std::string& path, int width, int height, const std::vector<unsigned char>& rgba) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
  cairo_surface_flush(surface);
  unsigned char* to = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  for (int y = 0; to && y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const unsigned char* p = &rgba[(std::size_t(y) * width + x) * 4];
      const std::uint32_t pixel = std::uint32_t(p[0]) << 16 | std::uint32_t(p[1]) << 8 | p[2];
      std::copy_n(reinterpret_cast<const unsigned char*>(&pixel), 4, to + std::ptrdiff_t(y) * stride + x * 4);
    }
  cairo_surface_mark_dirty(surface);
  const cairo_status_t status = cairo_surface_write_to_png(surface, path.c_str());
  cairo_surface_destroy(surface);
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error("the picture cannot be written", ErrorKind::runFailed).given(path).advise(cairo_status_to_string(status));
}

}  // namespace pectora::view
