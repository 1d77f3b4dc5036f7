#include "plugins/scan/file/units.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {

double millimetresPerUnit(const std::string& units, std::span<const Vec3> points) {
  if (units == "mm") return 1;
  if (units == "cm") return 10;
  if (units == "m") return 1000;
  if (units == "inch") return 25.4;
  Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  for (const Vec3& p : points)
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  const Vec3 size = high - low;
  const double extent = std::max({size.x, size.y, size.z});
  if (extent >= 100 && extent <= 2500) return 1;
  throw Error("the unit of the file is not known, and in millimetres the scan would not be the size of a torso")
      .of("units").given(fmt::format("a largest extent of {:.4g}", extent))
      .allowed("mm, cm, m or inch")
      .advise(fmt::format("Give units: it would be {:.4g} mm with \"cm\", {:.4g} mm with \"m\", {:.4g} mm with \"inch\"", 10 * extent, 1000 * extent, 25.4 * extent));
}

}  // namespace pectora
