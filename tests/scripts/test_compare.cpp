// scripts/compare.lua, as somebody with two surfaces runs it.
#include "tests/bench/surfaces/chest_fields.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace pectora;
using namespace pectora::bench;
namespace fs = std::filesystem;

namespace {

void writeObj(const Mesh& mesh, const fs::path& path) {
  std::ofstream file(path);
  file.precision(9);
  for (const Vec3& p : mesh.points) file << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const auto& t : mesh.triangles) file << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
}

}  // namespace

TEST(CompareScript, RegistersTwoSurfacesByLandmarksAndIcpAndPrintsTheTable) {
  const fs::path folder = scratch("compare");
  fs::remove_all(folder);
  fs::create_directories(folder);
  writeObj(reference(101), folder / "before.obj");
  writeObj(displaced(81, 0.2, 1), folder / "after.obj");
  std::ofstream landmarks(folder / "landmarks.csv");
  landmarks << "name,ct_x,ct_y,ct_z,scan_x,scan_y,scan_z\n";
  for (const auto& [x, z] : {std::pair{-100., 0.}, {100., 0.}, {0., 150.}, {0., -150.}}) {
    const Vec3 p = chestPoint(x, z), q = displace(p);
    landmarks << "l" << x << '_' << z << ',' << p.x << ',' << p.y << ',' << p.z << ',' << q.x + 1 << ',' << q.y - 1 << ',' << q.z << '\n';
  }
  landmarks.close();
  const std::string command = std::string(PECTORA_PROGRAM) + " run " + PECTORA_SOURCE + "/scripts/compare.lua before=" + (folder / "before.obj").string() +
                              " after=" + (folder / "after.obj").string() + " landmarks=" + (folder / "landmarks.csv").string() + " out=" + (folder / "out").string() + " > " +
                              (folder / "table.txt").string() + " 2> /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::ifstream table(folder / "table.txt");
  std::ostringstream text;
  text << table.rdbuf();
  EXPECT_NE(text.str().find("ICP: converged"), std::string::npos) << text.str();
  EXPECT_NE(text.str().find("both ways, mm"), std::string::npos) << text.str();
  EXPECT_TRUE(fs::exists(folder / "out" / "summary.json"));
  EXPECT_TRUE(fs::exists(folder / "out" / "after_vs_before.vtp"));
  fs::remove_all(folder);
}
