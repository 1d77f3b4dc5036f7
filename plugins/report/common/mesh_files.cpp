#include "plugins/report/common/mesh_files.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>

namespace pectora {
namespace {

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

// One array of a VTP file's appended data: its size, then its bytes.
template <class T>
std::size_t appendArray(std::string& data, const std::vector<T>& values) {
  const std::size_t offset = data.size();
  append(data, std::uint32_t(values.size() * sizeof(T)));
  data.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  return offset;
}

std::vector<float> flat(const std::vector<Vec3>& points) {
  std::vector<float> values;
  values.reserve(3 * points.size());
  for (const Vec3& p : points) values.insert(values.end(), {float(p.x), float(p.y), float(p.z)});
  return values;
}

std::string ply(const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                const std::vector<std::array<int, 3>>* triangles, const std::vector<PointField>& fields, const FileNote& note) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment SPACE=LPS mm\n";
  bytes += "comment pectora record " + note.recordKey + "\n";
  for (const PointField& f : fields)
    if (!f.unit.empty()) bytes += fmt::format("comment {} is in {}\n", f.name, f.unit);
  bytes += fmt::format("element vertex {}\nproperty float x\nproperty float y\nproperty float z\n", points.size());
  if (!normals.empty()) bytes += "property float nx\nproperty float ny\nproperty float nz\n";
  for (const PointField& f : fields) bytes += "property float " + f.name + "\n";
  if (triangles) bytes += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", triangles->size());
  bytes += "end_header\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int a = 0; a < 3; ++a) append(bytes, float(points[i][a]));
    if (!normals.empty())
      for (int a = 0; a < 3; ++a) append(bytes, float(normals[i][a]));
    for (const PointField& f : fields) append(bytes, float(f.values[i]));
  }
  if (triangles) {
    for (const auto& t : *triangles) {
      append(bytes, std::uint8_t(3));
      for (int corner : t) append(bytes, std::int32_t(corner));
    }
  }
  return bytes;
}

std::string vtp(const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>* triangles,
                const std::vector<PointField>& fields, const FileNote& note) {
  std::string data;
  const std::size_t pointOffset = appendArray(data, flat(points));
  // Cells: triangles, or a vertex each.
  std::vector<std::int32_t> connectivity, ends;
  if (triangles) {
    for (const auto& t : *triangles) {
      connectivity.insert(connectivity.end(), t.begin(), t.end());
      ends.push_back(std::int32_t(connectivity.size()));
    }
  } else {
    for (std::size_t i = 0; i < points.size(); ++i) connectivity.push_back(std::int32_t(i)), ends.push_back(std::int32_t(i + 1));
  }
  const std::size_t connectivityOffset = appendArray(data, connectivity), endOffset = appendArray(data, ends);
  std::string pointData;
  for (const PointField& f : fields) {
    const std::size_t offset = appendArray(data, std::vector<float>(f.values.begin(), f.values.end()));
    pointData += fmt::format("<DataArray type=\"Float32\" Name=\"{}{}\" format=\"appended\" offset=\"{}\"/>\n", f.name,
                             f.unit.empty() ? "" : " [" + f.unit + "]", offset);
  }
  const char* cells = triangles ? "Polys" : "Verts";
  std::string bytes = "<?xml version=\"1.0\"?>\n<!-- SPACE=LPS mm; pectora record " + note.recordKey + " -->\n";
  bytes += "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n<PolyData>\n";
  bytes += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n",
                       points.size(), triangles ? 0 : points.size(), triangles ? triangles->size() : 0);
  bytes += "<PointData>\n" + pointData + "</PointData>\n";
  bytes += fmt::format("<Points>\n<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"appended\" offset=\"{}\"/>\n</Points>\n", pointOffset);
  bytes += fmt::format("<{0}>\n<DataArray type=\"Int32\" Name=\"connectivity\" format=\"appended\" offset=\"{1}\"/>\n"
                       "<DataArray type=\"Int32\" Name=\"offsets\" format=\"appended\" offset=\"{2}\"/>\n</{0}>\n",
                       cells, connectivityOffset, endOffset);
  return bytes + "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_" + data + "\n</AppendedData>\n</VTKFile>\n";
}

}  // namespace

std::string plyBytes(const Mesh& mesh, const FileNote& note) { return ply(mesh.points, {}, &mesh.triangles, mesh.fields, note); }
std::string plyBytes(const Points& points, const FileNote& note) {
  return ply(points.points, points.normals, nullptr, points.fields, note);
}
std::string vtpBytes(const Mesh& mesh, const FileNote& note) { return vtp(mesh.points, &mesh.triangles, mesh.fields, note); }
std::string vtpBytes(const Points& points, const FileNote& note) { return vtp(points.points, nullptr, points.fields, note); }

Mesh barMesh(const std::vector<Bar>& bars) {
  Mesh mesh;
  for (const Bar& bar : bars) {
    const std::vector<Vec3>& line = bar.centerline;
    const int count = int(line.size()), base = int(mesh.points.size());
    for (int i = 0; i < count; ++i) {
      const Vec3 along = normalized(line[std::min(i + 1, count - 1)] - line[std::max(i - 1, 0)]);
      const Vec3 up = bar.up * (bar.width / 2), out = normalized(cross(along, bar.up)) * (bar.height / 2);
      for (const Vec3& corner : {up + out, up - out, -up - out, -up + out}) mesh.points.push_back(line[i] + corner);
    }
    for (int i = 0; i + 1 < count; ++i) {
      for (int k = 0; k < 4; ++k) {
        const int a = base + 4 * i + k, b = base + 4 * i + (k + 1) % 4;
        mesh.triangles.push_back({a, b + 4, b});
        mesh.triangles.push_back({a, a + 4, b + 4});
      }
    }
    if (count < 2) continue;
    const int last = base + 4 * (count - 1);
    mesh.triangles.insert(mesh.triangles.end(), {{base, base + 2, base + 3}, {base, base + 1, base + 2}, {last, last + 2, last + 1}, {last, last + 3, last + 2}});
  }
  return mesh;
}

}  // namespace pectora
