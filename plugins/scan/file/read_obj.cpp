#include "plugins/scan/file/line_reader.h"
#include "plugins/scan/file/read_surface.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

namespace pectora {

RawSurface readObj(std::string_view bytes) {
  RawSurface surface;
  LineReader lines(bytes);
  std::string_view line;
  // Faces may come before their vertices: indices are checked at the end, relative ones resolved at once.
  std::vector<std::vector<long long>> faces;
  std::string joined;
  while (lines.next(line)) {
    // A line that ends with a backslash goes on in the next.
    if (line.ends_with('\\')) {
      joined.clear();
      do {
        joined.append(line.substr(0, line.size() - 1)).append(" ");
      } while (lines.next(line) && line.ends_with('\\'));
      joined.append(line);
      line = joined;
    }
    std::string_view words = line;
    const std::string_view keyword = takeWord(words);
    if (keyword == "v") {
      std::optional<double> xyz[3];
      for (auto& value : xyz) value = toNumber(takeWord(words));
      if (!xyz[0] || !xyz[1] || !xyz[2]) throw Error("a vertex needs three numbers").at(fmt::format("line {}", lines.number()));
      surface.points.push_back({*xyz[0], *xyz[1], *xyz[2]});
    } else if (keyword == "f") {
      std::vector<long long> corners;
      for (std::string_view word = takeWord(words); !word.empty(); word = takeWord(words)) {
        const auto index = toInteger(word.substr(0, word.find('/')));
        if (!index || *index == 0) throw Error("a face has a corner that is no index").given(std::string(word)).at(fmt::format("line {}", lines.number()));
        corners.push_back(*index > 0 ? *index - 1 : (long long)(surface.points.size()) + *index);
      }
      faces.push_back(std::move(corners));
    }
  }
  std::size_t bad = 0;
  for (const auto& corners : faces) {
    bool good = true;
    for (long long c : corners) good = good && c >= 0 && c < (long long)(surface.points.size());
    if (!good) {
      ++bad;
      continue;
    }
    for (std::size_t i = 2; i < corners.size(); ++i) surface.triangles.push_back({int(corners[0]), int(corners[i - 1]), int(corners[i])});
  }
  if (bad > 0) surface.notes.push_back(fmt::format("{} faces with corners that do not exist were left out", bad));
  return surface;
}

}  // namespace pectora
