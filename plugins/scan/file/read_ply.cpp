#include "plugins/scan/file/line_reader.h"
#include "plugins/scan/file/read_surface.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace pectora {
namespace {

enum class Format { ascii, littleEndian, bigEndian };
enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };

struct Property {
  std::string name;
  Type type = Type::f32;
  bool isList = false;
  Type countType = Type::u8;
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

std::optional<Type> typeOf(std::string_view word) {
  static constexpr std::pair<std::string_view, Type> kTypes[] = {
      {"char", Type::i8},    {"int8", Type::i8},    {"uchar", Type::u8},   {"uint8", Type::u8},    {"short", Type::i16}, {"int16", Type::i16},
      {"ushort", Type::u16}, {"uint16", Type::u16}, {"int", Type::i32},    {"int32", Type::i32},   {"uint", Type::u32},  {"uint32", Type::u32},
      {"float", Type::f32},  {"float32", Type::f32}, {"double", Type::f64}, {"float64", Type::f64}};
  for (const auto& [name, type] : kTypes)
    if (word == name) return type;
  return std::nullopt;
}

std::size_t sizeOf(Type type) {
  static constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[int(type)];
}

template <class T>
double decode(const char* bytes, bool swap) {
  char raw[sizeof(T)];
  for (std::size_t i = 0; i < sizeof(T); ++i) raw[i] = bytes[swap ? sizeof(T) - 1 - i : i];
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return double(value);
}

double decode(Type type, const char* bytes, bool swap) {
  switch (type) {
    case Type::i8: return decode<std::int8_t>(bytes, swap);
    case Type::u8: return decode<std::uint8_t>(bytes, swap);
    case Type::i16: return decode<std::int16_t>(bytes, swap);
    case Type::u16: return decode<std::uint16_t>(bytes, swap);
    case Type::i32: return decode<std::int32_t>(bytes, swap);
    case Type::u32: return decode<std::uint32_t>(bytes, swap);
    case Type::f32: return decode<float>(bytes, swap);
    case Type::f64: return decode<double>(bytes, swap);
  }
  return 0;
}

struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;
  std::string_view body;
};

Header readHeader(std::string_view bytes) {
  Header header;
  LineReader lines(bytes);
  std::string_view line;
  lines.next(line);  // "ply"
  bool hasFormat = false;
  while (lines.next(line)) {
    const auto fail = [&](const std::string& what) -> Error { return Error(what).at(fmt::format("line {} of the header", lines.number())); };
    std::string_view words = line;
    const std::string_view keyword = takeWord(words);
    if (keyword == "end_header") {
      header.body = lines.rest();
      if (!hasFormat) throw Error("the PLY header names no format");
      return header;
    }
    if (keyword == "format") {
      const std::string_view name = takeWord(words);
      if (name == "ascii") header.format = Format::ascii;
      else if (name == "binary_little_endian") header.format = Format::littleEndian;
      else if (name == "binary_big_endian") header.format = Format::bigEndian;
      else throw fail("unknown PLY format").given(std::string(name));
      hasFormat = true;
    } else if (keyword == "element") {
      const std::string_view name = takeWord(words);
      const auto count = toInteger(takeWord(words));
      if (!count || *count < 0) throw fail("an element needs a count");
      header.elements.push_back({std::string(name), std::size_t(*count), {}});
    } else if (keyword == "property") {
      if (header.elements.empty()) throw fail("a property stands before the first element");
      Property property;
      std::string_view word = takeWord(words);
      if (word == "list") {
        property.isList = true;
        const auto countType = typeOf(takeWord(words));
        if (!countType) throw fail("a list needs the type of its count");
        property.countType = *countType;
        word = takeWord(words);
      }
      const auto type = typeOf(word);
      if (!type) throw fail("unknown type").given(std::string(word));
      property.type = *type;
      property.name = takeWord(words);
      header.elements.back().properties.push_back(std::move(property));
    }
    // "comment", "obj_info" and words of other programs are passed over.
  }
  throw Error("the PLY header has no end_header");
}

// Gives the body's values one by one; nothing where it ends.
class Body {
 public:
  Body(std::string_view bytes, Format format) : rest_(bytes), format_(format) {}

  std::optional<double> next(Type type) {
    if (format_ == Format::ascii) {
      const std::size_t begin = rest_.find_first_not_of(" \t\r\n");
      if (begin == std::string_view::npos) return std::nullopt;
      rest_.remove_prefix(begin);
      const std::size_t end = std::min(rest_.find_first_of(" \t\r\n"), rest_.size());
      const auto value = toNumber(rest_.substr(0, end));
      rest_.remove_prefix(end);
      return value;
    }
    const std::size_t size = sizeOf(type);
    if (rest_.size() < size) return std::nullopt;
    const bool swap = (format_ == Format::bigEndian) == (std::endian::native == std::endian::little);
    const double value = decode(type, rest_.data(), swap);
    rest_.remove_prefix(size);
    return value;
  }

 private:
  std::string_view rest_;
  Format format_;
};

[[noreturn]] void truncated(const Element& element, std::size_t index) {
  throw Error("the PLY file ends too early, or holds a word that is no number")
      .at(fmt::format("{} {} of {}", element.name, index + 1, element.count)).advise("Export or copy it again");
}

void readVertex(const Element& element, std::size_t index, Body& body, RawSurface& surface) {
  Vec3 position, normal;
  bool hasNormal = false;
  for (const Property& p : element.properties) {
    if (p.isList) {
      const auto count = body.next(p.countType);
      if (!count || !(*count >= 0)) truncated(element, index);
      for (std::size_t i = 0; i < std::size_t(*count); ++i)
        if (!body.next(p.type)) truncated(element, index);
      continue;
    }
    const auto value = body.next(p.type);
    if (!value) truncated(element, index);
    if (p.name == "x") position.x = *value;
    if (p.name == "y") position.y = *value;
    if (p.name == "z") position.z = *value;
    if (p.name == "nx") normal.x = *value, hasNormal = true;
    if (p.name == "ny") normal.y = *value;
    if (p.name == "nz") normal.z = *value;
  }
  surface.points.push_back(position);
  if (hasNormal) surface.normals.push_back(isFinite(normal) ? normalized(normal) : Vec3{});
}

void readFace(const Element& element, std::size_t index, Body& body, RawSurface& surface, std::size_t& bad) {
  std::vector<int> corners;
  for (const Property& p : element.properties) {
    if (!p.isList) {
      if (!body.next(p.type)) truncated(element, index);
      continue;
    }
    const auto count = body.next(p.countType);
    if (!count || !(*count >= 0)) truncated(element, index);
    const bool isIndices = p.name == "vertex_indices" || p.name == "vertex_index";
    for (std::size_t i = 0; i < std::size_t(*count); ++i) {
      const auto value = body.next(p.type);
      if (!value) truncated(element, index);
      if (isIndices) corners.push_back(*value >= 0 && *value < double(std::numeric_limits<int>::max()) && *value == std::floor(*value) ? int(*value) : -1);
    }
  }
  for (int corner : corners)
    if (corner < 0 || std::size_t(corner) >= surface.points.size()) {
      ++bad;
      return;
    }
  for (std::size_t i = 2; i < corners.size(); ++i) surface.triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

}  // namespace

RawSurface readPly(std::string_view bytes) {
  const Header header = readHeader(bytes);
  Body body(header.body, header.format);
  RawSurface surface;
  std::size_t badFaces = 0;
  for (const Element& element : header.elements) {
    if (element.properties.empty()) continue;  // elements without content take no bytes
    const bool isVertex = element.name == "vertex";
    if (isVertex) {
      int axes = 0;
      for (const Property& p : element.properties) axes += !p.isList && (p.name == "x" || p.name == "y" || p.name == "z");
      if (axes != 3) throw Error("the PLY file's vertices have no x, y and z");
    }
    for (std::size_t i = 0; i < element.count; ++i) {
      if (element.name == "face") {
        readFace(element, i, body, surface, badFaces);
      } else if (isVertex) {
        readVertex(element, i, body, surface);
      } else {
        RawSurface ignored;
        std::size_t none = 0;
        readFace(element, i, body, ignored, none);
      }
    }
  }
  if (!surface.normals.empty() && surface.normals.size() != surface.points.size()) surface.normals.clear();
  if (badFaces > 0) surface.notes.push_back(fmt::format("{} faces with corners that do not exist were left out", badFaces));
  return surface;
}

}  // namespace pectora
