// Colours for figures, the same in the scene and in its colour bar.
#pragma once

#include <array>

namespace pectora::view {

using Rgb = std::array<float, 3>;
enum class ColorMap { none, sequential, diverging };

inline constexpr int kColorStops = 9;
/// The colours at equal steps from low to high; linear between them. Sequential grows in lightness, diverging is pale in the middle.
const std::array<Rgb, kColorStops>& colorStops(ColorMap map);
/// t from 0 to 1.
Rgb colorAt(ColorMap map, double t);
/// A round figure that holds 98 % of the absolute values.
double roundLimit(const double* values, std::size_t count);

}  // namespace pectora::view
