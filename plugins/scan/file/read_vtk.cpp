#include "plugins/scan/file/line_reader.h"
#include "plugins/scan/file/read_surface.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

namespace pectora {
namespace {

// Gives the words of a text, whatever stands between them.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  std::string_view peek() {
    const std::size_t begin = rest_.find_first_not_of(" \t\r\n");
    rest_.remove_prefix(begin == std::string_view::npos ? rest_.size() : begin);
    return rest_.substr(0, rest_.find_first_of(" \t\r\n"));
  }
  std::string_view take() {
    const std::string_view word = peek();
    rest_.remove_prefix(word.size());
    return word;
  }
  /// All numbers up to the next word that is none: counts in headers are not trusted.
  std::vector<double> numbers() {
    std::vector<double> values;
    for (std::string_view word = peek(); !word.empty(); word = peek()) {
      const auto value = toNumber(word);
      if (!value) break;
      values.push_back(*value);
      take();
    }
    return values;
  }

 private:
  std::string_view rest_;
};

int indexOf(double value, std::size_t points) {
  return value >= 0 && value < double(points) && value == double(int(value)) ? int(value) : -1;
}

// Polygons become fans, strips are turned triangle by triangle.
void addCell(const std::vector<int>& corners, bool isStrip, RawSurface& surface, std::size_t& bad) {
  for (int corner : corners)
    if (corner < 0) {
      ++bad;
      return;
    }
  for (std::size_t i = 2; i < corners.size(); ++i) {
    if (!isStrip) surface.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    else if (i % 2 == 0) surface.triangles.push_back({corners[i - 2], corners[i - 1], corners[i]});
    else surface.triangles.push_back({corners[i - 1], corners[i - 2], corners[i]});
  }
}

// Cells as "k i1 ... ik", or as OFFSETS and CONNECTIVITY (version 5).
void readCells(Words& words, bool isStrip, RawSurface& surface, std::size_t& bad) {
  const std::size_t points = surface.points.size();
  std::vector<double> values = words.numbers();   // number of cells, size of the list, and in version 3 the list itself
  if (words.peek() != "OFFSETS") {
    for (std::size_t i = 2; i < values.size();) {
      const double count = values[i++];
      if (!(count >= 0) || count > double(values.size() - i)) {
        ++bad;
        return;
      }
      std::vector<int> corners;
      for (std::size_t k = 0; k < std::size_t(count); ++k) corners.push_back(indexOf(values[i++], points));
      addCell(corners, isStrip, surface, bad);
    }
    return;
  }
  words.take(), words.take();   // OFFSETS type
  const std::vector<double> offsets = words.numbers();
  if (words.peek() != "CONNECTIVITY") throw Error("a VTK file's OFFSETS are not followed by CONNECTIVITY");
  words.take(), words.take();
  const std::vector<double> connectivity = words.numbers();
  for (std::size_t cell = 0; cell + 1 < offsets.size(); ++cell) {
    const double begin = offsets[cell], end = offsets[cell + 1];
    if (!(begin >= 0 && begin <= end && end <= double(connectivity.size()))) {
      ++bad;
      continue;
    }
    std::vector<int> corners;
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) corners.push_back(indexOf(connectivity[i], points));
    addCell(corners, isStrip, surface, bad);
  }
}

std::vector<Vec3> readTriples(Words& words) {
  const std::vector<double> values = words.numbers();
  std::vector<Vec3> triples;
  for (std::size_t i = 2; i < values.size(); i += 3) triples.push_back({values[i - 2], values[i - 1], values[i]});
  return triples;
}

}  // namespace

RawSurface readVtk(std::string_view bytes) {
  LineReader lines(bytes);
  std::string_view line;
  lines.next(line);   // "# vtk DataFile Version ..."
  lines.next(line);   // a title
  Words words(lines.rest());
  const std::string_view format = words.take();
  if (format != "ASCII")
    throw Error("only text VTK files are read").given(std::string(format.substr(0, 20))).allowed("ASCII").advise("Export it as ASCII, or as PLY or STL");
  RawSurface surface;
  std::size_t bad = 0;
  bool isPointData = false;
  for (std::string_view word = words.take(); !word.empty(); word = words.take()) {
    if (word == "DATASET") {
      const std::string_view kind = words.take();
      if (kind != "POLYDATA") throw Error("the VTK file holds no surface").given(std::string(kind)).allowed("POLYDATA").advise("Export the surface as PLY or STL");
    } else if (word == "POINTS") {
      const auto promised = toInteger(words.take());
      words.take();   // type
      surface.points = readTriples(words);
      if (!promised || *promised != (long long)(surface.points.size()))
        surface.notes.push_back(fmt::format("the header's number of points is wrong; {} are there", surface.points.size()));
    } else if (word == "POLYGONS" || word == "TRIANGLE_STRIPS") {
      readCells(words, word == "TRIANGLE_STRIPS", surface, bad);
    } else if (word == "POINT_DATA" || word == "CELL_DATA") {
      isPointData = word == "POINT_DATA";
    } else if (word == "NORMALS" && isPointData) {
      words.take(), words.take();   // name, type
      surface.normals = readTriples(words);
    }
    // Vertices, lines, scalars and their numbers are passed over.
  }
  if (surface.normals.size() != surface.points.size()) surface.normals.clear();
  for (Vec3& n : surface.normals) n = isFinite(n) ? normalized(n) : Vec3{};
  if (bad > 0) surface.notes.push_back(fmt::format("{} faces with corners that do not exist were left out", bad));
  return surface;
}

}  // namespace pectora
