#include "plugins/loader/dicom/encapsulated.h"

namespace pectora::dicom {
namespace {

std::uint32_t word(const unsigned char* p) {
  return std::uint32_t(p[0]) | std::uint32_t(p[1]) << 8 | std::uint32_t(p[2]) << 16 | std::uint32_t(p[3]) << 24;
}

// Tags (FFFE,E000) and (FFFE,E0DD) as they lie in the file.
constexpr std::uint32_t kItem = 0xE000FFFEu, kDelimiter = 0xE0DDFFFEu;

// The marker stands at the end, perhaps with padding behind it.
bool hasEndMarker(const unsigned char* data, std::size_t length) {
  constexpr std::size_t kMostPadding = 16;
  for (std::size_t back = 2; back <= length && back <= kMostPadding; ++back)
    if (data[length - back] == 0xFF && data[length - back + 1] == 0xD9) return true;
  return false;
}

}  // namespace

std::string checkFragments(const unsigned char* file, std::size_t size, std::uint64_t offset, bool endsWithMarker) {
  const std::string truncated = "is truncated within its pixels";
  int items = 0;
  std::uint64_t lastAt = 0, lastLength = 0;
  while (true) {
    if (offset + 8 > size) return truncated;
    const std::uint32_t tag = word(file + offset);
    const std::uint64_t length = word(file + offset + 4);
    offset += 8;
    if (tag == kDelimiter) break;
    if (tag != kItem) return "has damaged fragments of compressed pixels";
    if (offset + length > size) return truncated;
    lastAt = offset, lastLength = length;
    offset += length;
    ++items;
  }
  // The first item is the table of offsets.
  if (items < 2 || lastLength == 0) return "has no pixels";
  if (endsWithMarker && !hasEndMarker(file + lastAt, lastLength)) return truncated;
  return "";
}

}  // namespace pectora::dicom
