// Follows a costal cartilage through the CT.
#pragma once

#include "kernel/value/volume.h"

#include <functional>
#include <optional>
#include <span>

namespace pectora {

struct TraceSettings {
  double cartilageHu = 100;   ///< mean of unossified cartilage
  double spacing = 1.5;       ///< of the grid that is searched, mm
  double margin = 22;         ///< how far the search reaches beyond the first guess, mm
};

/// The path of least cost from `start` to the first point that `isEnd` accepts, through a grid around `guess`. A step costs its
/// length, times more the less the mean HU within 4.5 mm looks like cartilage (calcified cartilage counts as such).
/// Nothing if no end is reached, or most of the path does not look like cartilage.
std::optional<std::vector<Vec3>> traceCartilage(const Volume& ct, Vec3 start, std::span<const Vec3> guess,
                                                const std::function<bool(Vec3)>& isEnd, const TraceSettings& settings);

}  // namespace pectora
