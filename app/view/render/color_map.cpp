#include "app/view/render/color_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pectora::view {

const std::array<Rgb, kColorStops>& colorStops(ColorMap map) {
  static constexpr std::array<Rgb, kColorStops> sequential{{{0.18f, 0.20f, 0.36f}, {0.17f, 0.31f, 0.50f}, {0.13f, 0.44f, 0.58f},
                                                            {0.12f, 0.56f, 0.60f}, {0.24f, 0.68f, 0.56f}, {0.45f, 0.77f, 0.48f},
                                                            {0.69f, 0.84f, 0.42f}, {0.89f, 0.88f, 0.45f}, {0.99f, 0.93f, 0.60f}}};
  static constexpr std::array<Rgb, kColorStops> diverging{{{0.13f, 0.29f, 0.58f}, {0.24f, 0.46f, 0.72f}, {0.46f, 0.66f, 0.84f},
                                                           {0.72f, 0.83f, 0.92f}, {0.94f, 0.94f, 0.93f}, {0.95f, 0.78f, 0.68f},
                                                           {0.89f, 0.55f, 0.43f}, {0.76f, 0.30f, 0.27f}, {0.58f, 0.11f, 0.18f}}};
  return map == ColorMap::diverging ? diverging : sequential;
}

Rgb colorAt(ColorMap map, double t) {
  const auto& stops = colorStops(map);
  const double x = std::clamp(t, 0.0, 1.0) * (kColorStops - 1);
  const int i = std::min(kColorStops - 2, int(x));
  Rgb c{};
  for (int k = 0; k < 3; ++k) c[k] = float(stops[i][k] + (stops[i + 1][k] - stops[i][k]) * (x - i));
  return c;
}

double roundLimit(const double* values, std::size_t count) {
  std::vector<double> absolute;
  for (std::size_t i = 0; i < count; ++i)
    if (std::isfinite(values[i])) absolute.push_back(std::abs(values[i]));
  if (absolute.empty()) return 1;
  const auto at = absolute.begin() + std::ptrdiff_t(0.98 * double(absolute.size() - 1));
  std::nth_element(absolute.begin(), at, absolute.end());
  for (double limit : {0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 25.0, 30.0, 40.0, 50.0, 80.0})
    if (limit >= *at) return limit;
  return 100;
}

}  // namespace pectora::view
