#include "plugins/scan/landmarks/read_landmarks.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

namespace pectora {
namespace {

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> parts;
  std::istringstream stream(line);
  for (std::string part; std::getline(stream, part, ',');) {
    const std::size_t begin = part.find_first_not_of(" \t\r"), end = part.find_last_not_of(" \t\r");
    parts.push_back(begin == std::string::npos ? "" : part.substr(begin, end - begin + 1));
  }
  return parts;
}

}  // namespace

Landmarks readLandmarks(const std::string& text, const std::string& set) {
  Landmarks landmarks;
  std::size_t first = 1;   // column of x
  std::istringstream stream(text);
  int number = 0;
  bool sawHeader = false;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.find_first_not_of(" \t,") == std::string::npos || line.front() == '#') continue;
    const std::vector<std::string> parts = cells(line);
    const auto where = fmt::format("line {}", number);
    if (!sawHeader && landmarks.points.empty() && parts.front() == "name") {
      sawHeader = true;
      if (set.empty()) continue;
      first = 0;
      for (std::size_t c = 1; c < parts.size(); ++c)
        if (parts[c] == set + "_x") first = c;
      if (first == 0) throw Error("the file has no column \"" + set + "_x\"").at(where).advise("Name the columns name,ct_x,ct_y,ct_z,scan_x,scan_y,scan_z");
      continue;
    }
    if (parts.size() < first + 3) throw Error("a landmark needs a name and three numbers").at(where).given(line);
    Landmark landmark{parts[0], {}};
    for (int a = 0; a < 3; ++a) {
      const std::string& cell = parts[first + a];
      char* end = nullptr;
      landmark.position[a] = std::strtod(cell.c_str(), &end);
      if (cell.empty() || *end != '\0' || !std::isfinite(landmark.position[a])) throw Error("this is not a number").at(where).given(cell);
    }
    if (landmark.name.empty()) throw Error("a landmark needs a name").at(where);
    if (landmarks.find(landmark.name)) throw Error("this landmark stands in the file twice").at(where).given(landmark.name);
    landmarks.points.push_back(std::move(landmark));
  }
  if (landmarks.points.empty()) throw Error("the file holds no landmarks").allowed("lines such as: neck, 1.5, -90, 20");
  return landmarks;
}

}  // namespace pectora
