#include "plugins/scan/file/read_surface.h"
#include "plugins/scan/file/units.h"

#include "kernel/stage/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>

using namespace pectora;

namespace {

template <class T>
std::string raw(T value, bool swap) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (swap) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

// A tetrahedron in each format.
const float kCorners[4][3] = {{0, 0, 0}, {100, 0, 0}, {0, 100, 0}, {0, 0, 100}};
const int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

std::string plyHeader(const char* format) {
  return std::string("ply\nformat ") + format + " 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
         "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string binaryPly(bool big) {
  std::string bytes = plyHeader(big ? "binary_big_endian" : "binary_little_endian");
  for (const auto& c : kCorners) {
    for (float v : c) bytes += raw(v, big);
    bytes += '\x7f';
  }
  for (const auto& f : kFaces) {
    bytes += '\x03';
    for (int i : f) bytes += raw(std::int32_t(i), big);
  }
  return bytes;
}

std::string asciiPly() {
  std::string text = plyHeader("ascii");
  for (const auto& c : kCorners) text += std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]) + " 127\n";
  for (const auto& f : kFaces) text += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) + "\n";
  return text;
}

std::string binaryStl(bool big) {
  std::string bytes(80, ' ');
  bytes += raw(std::uint32_t(4), big);
  for (const auto& f : kFaces) {
    for (int i = 0; i < 3; ++i) bytes += raw(0.0f, big);
    for (int corner : f)
      for (float v : kCorners[corner]) bytes += raw(v, big);
    bytes += std::string(2, '\0');
  }
  return bytes;
}

std::string asciiStl() {
  std::string text = "solid tetra\n";
  for (const auto& f : kFaces) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (int corner : f) text += "  vertex " + std::to_string(kCorners[corner][0]) + " " + std::to_string(kCorners[corner][1]) + " " + std::to_string(kCorners[corner][2]) + "\n";
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}

std::string obj() {
  std::string text = "# a tetrahedron\nmtllib none.mtl\n";
  for (const auto& c : kCorners) text += "v " + std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]) + "\n";
  return text + "vn 0 0 1\nf 1//1 3//1 2//1\nf 1 2 4\nf -4/7 -1/7 -2/7\nf 2 \\\n3 4\n";
}

const char* const kVtkHead = "# vtk DataFile Version 3.0\nFastSCAN\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 100 0 0\n0 100 0\n0 0 100\n";
std::string vtk() { return std::string(kVtkHead) + "POLYGONS 4 16\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\nPOINT_DATA 4\nSCALARS a float 1\nLOOKUP_TABLE default\n1 2 3 4\n"; }
std::string vtk5() {
  return std::string(kVtkHead) + "POLYGONS 5 12\nOFFSETS vtktypeint64\n0 3 6 9 12\nCONNECTIVITY vtktypeint64\n0 2 1 0 1 3\n0 3 2 1 2 3\n";
}

void expectTetrahedron(const RawSurface& s) {
  ASSERT_EQ(s.points.size(), 4u);
  ASSERT_EQ(s.triangles.size(), 4u);
  double volume = 0;
  for (const auto& t : s.triangles) volume += dot(s.points[t[0]], cross(s.points[t[1]], s.points[t[2]])) / 6;
  EXPECT_NEAR(volume, 1e6 / 6, 1e-3);
}

}  // namespace

TEST(ReadSurface, ReadsOneTetrahedronFromEveryFormat) {
  expectTetrahedron(readSurface(asciiPly(), "a.ply"));
  expectTetrahedron(readSurface(binaryPly(false), "a.ply"));
  expectTetrahedron(readSurface(binaryPly(true), "a.ply"));
  expectTetrahedron(readSurface(asciiStl(), "a.stl"));
  expectTetrahedron(readSurface(binaryStl(false), "A.STL"));
  expectTetrahedron(readSurface(binaryStl(true), "a.stl"));
  expectTetrahedron(readSurface(obj(), "a.obj"));
  expectTetrahedron(readSurface(vtk(), "a.vtk"));
  expectTetrahedron(readSurface(vtk5(), "a.vtk"));
}

TEST(ReadSurface, ReadsFastScanTextWithAWrongCountAndKeepsItsSweepsApart) {
  const RawSurface s = readSurface("% Copyright\r\n% Ascii 3D points file created by FastSCAN V4.0.7\r\n% 346306 3D points, x y z per line\r\n"
                                   " -106.93    99.80    68.81\r\n -106.28   100.26    67.09\r\n\r\n -105.16   100.67    66.55\r\n", "scan.txt");
  ASSERT_EQ(s.points.size(), 3u);
  EXPECT_EQ(s.points[0], (Vec3{-106.93, 99.80, 68.81}));
  EXPECT_EQ(s.sweeps, (std::vector<int>{0, 0, 1}));
}

TEST(ReadSurface, SurvivesAWrongFacetCountInAnStlHeader) {
  std::string bytes = binaryStl(false);
  bytes[80] = 77;
  const RawSurface s = readSurface(bytes, "a.stl");
  expectTetrahedron(s);
  EXPECT_EQ(s.notes.size(), 1u);
}

TEST(ReadSurface, ReadsVtkStripsNormalsAndWrongCountsAndRefusesBinary) {
  const std::string head(kVtkHead);
  const RawSurface strip = readSurface(head + "TRIANGLE_STRIPS 1 5\n4 0 1 2 3\n", "a.vtk");
  ASSERT_EQ(strip.triangles.size(), 2u);
  EXPECT_EQ(strip.triangles[1], (std::array<int, 3>{2, 1, 3}));
  const RawSurface cloud = readSurface(head + "VERTICES 4 8\n1 0 1 1 1 2 1 3\nPOINT_DATA 4\nNORMALS n float\n0 0 2 0 0 1 0 1 0 1 0 0\n", "a.vtk");
  EXPECT_TRUE(cloud.triangles.empty());
  ASSERT_EQ(cloud.normals.size(), 4u);
  EXPECT_EQ(cloud.normals[0], (Vec3{0, 0, 1}));
  std::string wrong = vtk();
  wrong.replace(wrong.find("POINTS 4"), 8, "POINTS 9");
  expectTetrahedron(readSurface(wrong, "a.vtk"));
  EXPECT_EQ(readSurface(wrong, "a.vtk").notes.size(), 1u);
  EXPECT_EQ(readSurface(head + "POLYGONS 2 8\n3 0 1 2 3 0 1 9\n", "a.vtk").triangles.size(), 1u);
  EXPECT_THROW(readSurface("# vtk DataFile Version 3.0\nx\nBINARY\nDATASET POLYDATA\n", "a.vtk"), Error);
  EXPECT_THROW(readSurface("# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\n", "a.vtk"), Error);
  EXPECT_THROW(readSurface("hello", "a.vtk"), Error);
}

TEST(ReadSurface, LeavesOutPointsThatAreNotFiniteAndSaysSo) {
  const RawSurface s = readSurface("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\nproperty list uchar int vertex_index\nend_header\n"
                                   "0 0 0\nnan 1 1\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 3\n", "a.ply");
  EXPECT_EQ(s.points.size(), 3u);
  EXPECT_EQ(s.triangles.size(), 1u);
  ASSERT_EQ(s.notes.size(), 1u);
}

TEST(ReadSurface, LeavesOutFacesWithCornersThatDoNotExist) {
  std::string text = asciiPly();
  text.replace(text.rfind("3 1 2 3"), 7, "3 1 2 9");
  const RawSurface s = readSurface(text, "a.ply");
  EXPECT_EQ(s.triangles.size(), 3u);
  EXPECT_EQ(s.notes.size(), 1u);
}

TEST(ReadSurface, RefusesWhatIsNoSurface) {
  for (const auto& [bytes, name] : {std::pair<std::string, std::string>{"", "a.ply"}, {"hello world", "a.ply"}, {"hello world", "a.xyz"}, {"hello", "a.stl"}, {"v 1 2\n", "a.obj"},
                                    {"f 1 2 3\n", "a.obj"}, {"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nend_header\n1\n2\n", "a.ply"},
                                    {"ply\nformat ascii 1.0\nelement vertex -3\nend_header\n", "a.ply"}, {"anything", "a.docx"}, {"% only comments\n", "a.txt"}})
    EXPECT_THROW(readSurface(bytes, name), Error) << name << ": " << bytes;
}

TEST(ReadSurface, RefusesAPlyThatEndsTooEarlyWhateverItPromises) {
  const std::string whole = binaryPly(false);
  for (std::size_t cut = plyHeader("binary_little_endian").size(); cut < whole.size(); ++cut) EXPECT_THROW(readSurface(whole.substr(0, cut), "a.ply"), Error) << cut;
  EXPECT_THROW(readSurface("ply\nformat binary_little_endian 1.0\nelement vertex 4000000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n", "a.ply"), Error);
}

TEST(ReadSurface, NeverCrashesOnMutatedFiles) {
  // 20,000 seeded mutations: read into finite points with good indices, or refused.
  std::mt19937 random(11);
  const std::pair<std::string, const char*> seeds[] = {{asciiPly(), "a.ply"}, {binaryPly(false), "a.ply"}, {binaryPly(true), "a.ply"}, {asciiStl(), "a.stl"},
                                                       {binaryStl(false), "a.stl"}, {obj(), "a.obj"}, {vtk(), "a.vtk"}, {vtk5(), "a.vtk"}, {"% x\n1 2 3\n4 5 6\n7 8 9\n", "a.txt"}};
  int read = 0;
  for (int i = 0; i < 20000; ++i) {
    auto [bytes, name] = seeds[i % std::size(seeds)];
    for (int k = 1 + int(random() % 4); k > 0 && !bytes.empty(); --k) {
      const std::size_t at = random() % bytes.size();
      switch (random() % 4) {
        case 0: bytes[at] = char(random()); break;
        case 1: bytes.resize(at); break;
        case 2: bytes.insert(at, 1, char("0123456789-. \n"[random() % 14])); break;
        case 3: bytes.erase(at, 1 + random() % 8); break;
      }
    }
    try {
      const RawSurface s = readSurface(bytes, name);
      ++read;
      for (const Vec3& p : s.points) ASSERT_TRUE(isFinite(p));
      for (const auto& t : s.triangles)
        for (int corner : t) ASSERT_TRUE(corner >= 0 && std::size_t(corner) < s.points.size());
      ASSERT_TRUE(s.normals.empty() || s.normals.size() == s.points.size());
      ASSERT_TRUE(s.sweeps.empty() || s.sweeps.size() == s.points.size());
    } catch (const Error&) {
    }
  }
  EXPECT_GT(read, 2000);
  EXPECT_LT(read, 19000);
}

TEST(Units, AreTakenAsGivenOrPlausibleOrAskedFor) {
  const std::vector<Vec3> torso{{-200, 0, 0}, {200, 300, 500}}, metres{{-.2, 0, 0}, {.2, .3, .5}};
  EXPECT_EQ(millimetresPerUnit("", torso), 1);
  EXPECT_EQ(millimetresPerUnit("m", metres), 1000);
  EXPECT_EQ(millimetresPerUnit("inch", metres), 25.4);
  EXPECT_EQ(millimetresPerUnit("mm", metres), 1);
  EXPECT_THROW(millimetresPerUnit("", metres), Error);
}

TEST(Units, AreSuggestedWhereTheyMakeATorso) {
  const auto said = [](double extent) -> std::string {
    const std::vector<Vec3> points{{0, 0, 0}, {0, 0, extent}};
    try {
      millimetresPerUnit("", points);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(said(0.5).find("500 mm with \"m\""), std::string::npos) << said(0.5);
  EXPECT_EQ(said(0.5).find("inch\""), std::string::npos) << said(0.5);
  EXPECT_NE(said(20).find("200 mm with \"cm\", 508 mm with \"inch\""), std::string::npos) << said(20);
  EXPECT_NE(said(1e-6).find("No unit"), std::string::npos) << said(1e-6);
  EXPECT_NE(said(1e6).find("No unit"), std::string::npos) << said(1e6);
}
