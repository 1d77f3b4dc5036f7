// Small smooth functions that shape the phantom.
#pragma once

#include <algorithm>
#include <cmath>

namespace pectora::phantom {

constexpr double kPi = 3.14159265358979323846;
constexpr double radians(double degrees) { return degrees * kPi / 180; }

/// Cubic Hermite step: 0 at or before `from`, 1 at or after `to`. `from` may be larger than `to`.
inline double step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// exp(-(x / width)^2).
inline double bell(double x, double width) { return std::exp(-(x / width) * (x / width)); }

/// Piecewise linear through (xs[i], ys[i]) with xs rising; constant beyond the ends.
template <std::size_t N>
double piecewise(const double (&xs)[N], const double (&ys)[N], double x) {
  if (x <= xs[0]) return ys[0];
  for (std::size_t i = 1; i < N; ++i)
    if (x <= xs[i]) return ys[i - 1] + (ys[i] - ys[i - 1]) * (x - xs[i - 1]) / (xs[i] - xs[i - 1]);
  return ys[N - 1];
}

}  // namespace pectora::phantom
