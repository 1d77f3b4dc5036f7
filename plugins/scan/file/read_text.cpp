#include "plugins/scan/file/line_reader.h"
#include "plugins/scan/file/read_surface.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

namespace pectora {

// Layout after real FastSCAN V4 files: "%" comment lines, then fixed-width "x y z" in mm. A blank line, or a comment between
// points, begins a new sweep. The number of points in the header is that of another file often enough, so it is not used.
RawSurface readFastScanText(std::string_view bytes) {
  RawSurface surface;
  LineReader lines(bytes);
  std::string_view line;
  int sweep = 0, bad = 0, firstBad = 0;
  bool sweepHasPoints = false;
  while (lines.next(line)) {
    const bool isComment = !line.empty() && (line.front() == '%' || line.front() == '#');
    const bool isBlank = line.find_first_not_of(" \t") == std::string_view::npos;
    if (isComment || isBlank) {
      if (sweepHasPoints) ++sweep, sweepHasPoints = false;
      continue;
    }
    std::optional<double> xyz[3];
    for (auto& value : xyz) value = toNumber(takeWord(line));
    if (!xyz[0] || !xyz[1] || !xyz[2]) {
      if (++bad == 1) firstBad = lines.number();
      continue;
    }
    surface.points.push_back({*xyz[0], *xyz[1], *xyz[2]});
    surface.sweeps.push_back(sweep);
    sweepHasPoints = true;
  }
  if (bad > 0 && std::size_t(bad) > surface.points.size() / 10 + 1)
    throw Error("this is no list of points: most lines do not hold three numbers").at(fmt::format("line {}", firstBad));
  if (bad > 0) surface.notes.push_back(fmt::format("{} lines that do not hold three numbers were passed over, the first is line {}", bad, firstBad));
  return surface;
}

}  // namespace pectora
