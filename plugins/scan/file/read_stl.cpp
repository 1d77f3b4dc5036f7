#include "plugins/scan/file/line_reader.h"
#include "plugins/scan/file/read_surface.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace pectora {
namespace {

constexpr std::size_t kHeader = 84, kFacet = 50;

std::uint32_t word(const char* bytes, bool swap) {
  std::uint32_t value;
  std::memcpy(&value, bytes, 4);
  return swap ? __builtin_bswap32(value) : value;
}

// Whether the bytes are a binary STL in one byte order: the count of facets agrees with the size, or nearly so.
bool isBinary(std::string_view bytes, bool swap) {
  if (bytes.size() < kHeader) return false;
  const std::uint64_t count = word(bytes.data() + 80, swap);
  return count > 0 && kHeader + count * kFacet == bytes.size();
}

RawSurface readBinary(std::string_view bytes, bool swap, std::size_t count) {
  RawSurface surface;
  surface.points.reserve(3 * count);
  for (std::size_t f = 0; f < count; ++f) {
    const char* facet = bytes.data() + kHeader + f * kFacet + 12;
    const int first = int(surface.points.size());
    for (int corner = 0; corner < 3; ++corner) {
      float xyz[3];
      for (int a = 0; a < 3; ++a) xyz[a] = std::bit_cast<float>(word(facet + 12 * corner + 4 * a, swap));
      surface.points.push_back({xyz[0], xyz[1], xyz[2]});
    }
    surface.triangles.push_back({first, first + 1, first + 2});
  }
  return surface;
}

RawSurface readAscii(std::string_view bytes) {
  RawSurface surface;
  LineReader lines(bytes);
  std::string_view line;
  int corners = 0;
  while (lines.next(line)) {
    std::string_view words = line;
    const std::string_view keyword = takeWord(words);
    if (keyword == "vertex") {
      std::optional<double> xyz[3];
      for (auto& value : xyz) value = toNumber(takeWord(words));
      if (!xyz[0] || !xyz[1] || !xyz[2]) throw Error("a vertex needs three numbers").at(fmt::format("line {}", lines.number()));
      surface.points.push_back({*xyz[0], *xyz[1], *xyz[2]});
      ++corners;
    } else if (keyword == "endloop") {
      const int first = int(surface.points.size()) - corners;
      for (int i = 2; i < corners; ++i) surface.triangles.push_back({first, first + i - 1, first + i});
      corners = 0;
    }
  }
  if (corners > 0) surface.notes.push_back("the last facet is not complete and was left out");
  return surface;
}

}  // namespace

RawSurface readStl(std::string_view bytes) {
  RawSurface surface;
  if (isBinary(bytes, false) || isBinary(bytes, true)) {
    const bool swap = !isBinary(bytes, false);
    surface = readBinary(bytes, swap, (bytes.size() - kHeader) / kFacet);
    if (swap) surface.notes.push_back("the file is in the other byte order, which was undone");
  } else if (bytes.substr(0, 512).find("solid") != std::string_view::npos && bytes.find("vertex") != std::string_view::npos) {
    surface = readAscii(bytes);
  } else if (bytes.size() > kHeader + kFacet && (bytes.size() - kHeader) % kFacet == 0) {
    // A wrong count in the header, but whole facets.
    const std::size_t count = (bytes.size() - kHeader) / kFacet;
    surface = readBinary(bytes, false, count);
    surface.notes.push_back(fmt::format("the header's number of facets is wrong; {} are there", count));
  } else {
    throw Error("this is neither a whole binary STL nor a text one: its size does not fit a number of facets")
        .given(fmt::format("{} bytes", bytes.size())).advise("Export or copy it again");
  }
  mergeEqualPoints(surface);
  return surface;
}

}  // namespace pectora
