#include "plugins/segmenter/thorax/surface_metal.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pectora::thorax {
namespace {

constexpr float kMetalHu = 200, kBrightestHu = 500, kAirHu = -1000;
constexpr double kShallowMm = 3, kLargestMm2 = 200;

/// All pixels that can be reached from some by steps to one of four neighbours that pass a test; the first ones are among them.
template <class Test>
std::vector<int> reach(std::vector<int> pixels, std::vector<char>& isSeen, int width, int height, Test&& passes) {
  for (int n : pixels) isSeen[n] = 1;
  for (std::size_t at = 0; at < pixels.size(); ++at) {
    const int n = pixels[at], i = n % width, j = n / width;
    const auto visit = [&](int m) {
      if (!isSeen[m] && passes(m)) isSeen[m] = 1, pixels.push_back(m);
    };
    if (i > 0) visit(n - 1);
    if (i + 1 < width) visit(n + 1);
    if (j > 0) visit(n - width);
    if (j + 1 < height) visit(n + width);
  }
  return pixels;
}

/// Calls f(pixel) for all pixels at most so many columns and rows from one, and itself.
template <class F>
void around(int n, int columns, int rows, int width, int height, F&& f) {
  const int i = n % width, j = n / width;
  for (int y = std::max(0, j - rows); y <= std::min(height - 1, j + rows); ++y)
    for (int x = std::max(0, i - columns); x <= std::min(width - 1, i + columns); ++x) f(y * width + x);
}

}  // namespace

void removeSurfaceMetal(Plane& plane, Vec3 spacing, float levelHu) {
  const int w = plane.width, h = plane.height;
  const auto isMetal = [&](int n) { return plane.value[n] > kMetalHu; };
  const auto isDark = [&](int n) { return plane.value[n] < levelHu; };
  std::vector<int> border;
  for (int n = 0; n < w * h; ++n)
    if ((n % w == 0 || n % w == w - 1 || n < w || n >= w * (h - 1)) && isDark(n)) border.push_back(n);
  std::vector<char> isOutside(plane.value.size(), 0);
  const std::vector<int> outside = reach(std::move(border), isOutside, w, h, isDark);

  // Bright pixels close to the air outside, each with the piece that it belongs to.
  const int columns = int(kShallowMm / spacing.x), rows = int(kShallowMm / spacing.y);
  std::vector<char> isSeen(plane.value.size(), 0);
  std::vector<std::vector<int>> pieces;
  for (int n : outside) {
    // What is close to air is close to its rim.
    bool isRim = false;
    around(n, 1, 1, w, h, [&](int m) { isRim = isRim || !isOutside[m]; });
    if (!isRim) continue;
    around(n, columns, rows, w, h, [&](int m) {
      if (!isSeen[m] && isMetal(m)) pieces.push_back(reach({m}, isSeen, w, h, isMetal));
    });
  }
  for (const std::vector<int>& piece : pieces) {
    const bool isBright = std::any_of(piece.begin(), piece.end(), [&](int n) { return plane.value[n] > kBrightestHu; });
    if (isBright && double(piece.size()) * spacing.x * spacing.y <= kLargestMm2)
      for (int n : piece) around(n, 1, 1, w, h, [&](int m) { plane.value[m] = kAirHu; });
  }
}

}  // namespace pectora::thorax
