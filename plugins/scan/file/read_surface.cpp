#include "plugins/scan/file/read_surface.h"

#include "kernel/stage/error.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>

namespace pectora {
namespace {

bool endsWith(const std::string& name, const char* ending) {
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return lower.ends_with(ending);
}

RawSurface readAny(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) throw Error("the file is empty");
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return readPly(bytes);
  if (bytes.starts_with("# vtk DataFile")) return readVtk(bytes);
  if (endsWith(name, ".vtk")) throw Error("a VTK file begins with the line \"# vtk DataFile Version\", this one does not");
  if (endsWith(name, ".ply")) throw Error("a PLY file begins with the line \"ply\", this one does not");
  if (endsWith(name, ".stl")) return readStl(bytes);
  if (endsWith(name, ".obj")) return readObj(bytes);
  if (endsWith(name, ".txt") || endsWith(name, ".xyz") || endsWith(name, ".asc") || bytes.starts_with("%")) return readFastScanText(bytes);
  throw Error("the format of the file is not known").allowed("FastSCAN text (.txt), .ply, .stl, .obj, .vtk").advise("Export the scan in one of these");
}

// Points that are not finite leave, with the triangles that use them.
void dropNotFinite(RawSurface& surface) {
  std::vector<int> newIndex(surface.points.size(), -1);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    // Beyond 1e9 no unit makes sense, and squares of it lose all digits.
    const Vec3 p = surface.points[i];
    if (!isFinite(p) || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > 1e9) continue;
    newIndex[i] = int(kept);
    surface.points[kept] = p;
    if (!surface.normals.empty()) surface.normals[kept] = surface.normals[i];
    if (!surface.sweeps.empty()) surface.sweeps[kept] = surface.sweeps[i];
    ++kept;
  }
  const std::size_t dropped = surface.points.size() - kept;
  if (dropped == 0) return;
  surface.points.resize(kept);
  if (!surface.normals.empty()) surface.normals.resize(kept);
  if (!surface.sweeps.empty()) surface.sweeps.resize(kept);
  std::vector<std::array<int, 3>> triangles;
  for (const auto& t : surface.triangles)
    if (newIndex[t[0]] >= 0 && newIndex[t[1]] >= 0 && newIndex[t[2]] >= 0)
      triangles.push_back({newIndex[t[0]], newIndex[t[1]], newIndex[t[2]]});
  surface.triangles = std::move(triangles);
  surface.notes.push_back(std::to_string(dropped) + " points with coordinates that are no finite numbers were left out");
}

}  // namespace

RawSurface readSurface(std::string_view bytes, const std::string& name) {
  RawSurface surface = readAny(bytes, name);
  dropNotFinite(surface);
  if (surface.points.empty()) throw Error("the file holds no points");
  return surface;
}

void mergeEqualPoints(RawSurface& surface) {
  struct Hash {
    std::size_t operator()(const std::array<std::uint64_t, 3>& k) const {
      std::uint64_t h = 1469598103934665603ull;
      for (std::uint64_t v : k) h = (h ^ v) * 1099511628211ull, h ^= h >> 29;
      return h;
    }
  };
  std::unordered_map<std::array<std::uint64_t, 3>, int, Hash> seen;
  seen.reserve(surface.points.size());
  std::vector<int> newIndex(surface.points.size());
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    std::array<std::uint64_t, 3> bits;
    // Adding zero makes -0 and 0 one.
    const double xyz[3] = {surface.points[i].x + 0.0, surface.points[i].y + 0.0, surface.points[i].z + 0.0};
    std::memcpy(bits.data(), xyz, sizeof xyz);
    const auto [entry, isNew] = seen.emplace(bits, int(points.size()));
    if (isNew) points.push_back(surface.points[i]);
    newIndex[i] = entry->second;
  }
  surface.points = std::move(points);
  surface.normals.clear();
  for (auto& t : surface.triangles) t = {newIndex[t[0]], newIndex[t[1]], newIndex[t[2]]};
  std::erase_if(surface.triangles, [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

}  // namespace pectora
