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
  const auto isTorso = [](double mm) { return mm >= 100 && mm <= 2500; };
  if (isTorso(extent)) return 1;
  // Which units would make it a torso.
  std::string fitting;
  for (const auto& [unit, scale] : {std::pair{"cm", 10.0}, {"m", 1000.0}, {"inch", 25.4}})
    if (isTorso(scale * extent)) fitting += fmt::format("{}{:.4g} mm with \"{}\"", fitting.empty() ? "" : ", ", scale * extent, unit);
  throw Error("the unit of the file is not known, and in millimetres the scan would not be the size of a torso")
      .of("units").given(fmt::format("a largest extent of {:.4g}", extent))
      .allowed("mm, cm, m or inch")
      .advise(fitting.empty() ? "No unit makes it a torso: check the file, or give units nevertheless" : "Give units: it would be " + fitting);
}

}  // namespace pectora
