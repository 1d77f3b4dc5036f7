#include "plugins/scan/file/read_surface.h"
#include "plugins/scan/file/units.h"

#include "kernel/stage/plugin.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace {
using namespace pectora;

class ScanFile final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.text("path", path_, TextRole::inputPath, "The scanner's file: FastSCAN text, PLY, STL, OBJ or VTK");
    v.choice("units", units_, {"", "mm", "cm", "m", "inch"}, "Unit of the file's coordinates; empty: millimetres if that makes it the size of a torso, else it is asked for");
  }

  Outputs run(const Inputs&, Host& host) override {
    if (path_.empty()) throw Error("a file is needed").of("path");
    std::ifstream file(path_, std::ios::binary);
    if (!file || std::filesystem::is_directory(path_)) throw Error("the file cannot be read").of("path").given(path_);
    std::ostringstream text;
    text << file.rdbuf();
    const std::string bytes = text.str();
    RawSurface surface;
    try {
      surface = readSurface(bytes, path_);
    } catch (Error& error) {
      throw error.of(std::filesystem::path(path_).filename().string());
    }
    for (const std::string& note : surface.notes) host.warn(note);

    const double scale = millimetresPerUnit(units_, surface.points);
    if (units_.empty()) host.info("coordinates are taken as millimetres, in which the scan has the size of a torso; units=... says otherwise");
    for (Vec3& p : surface.points) p *= scale;
    if (!surface.triangles.empty()) {
      auto mesh = std::make_shared<Mesh>();
      mesh->points = std::move(surface.points);
      mesh->triangles = std::move(surface.triangles);
      return {mesh};
    }
    auto points = std::make_shared<Points>();
    points->points = std::move(surface.points);
    points->normals = std::move(surface.normals);
    points->sweeps = std::move(surface.sweeps);
    return {points};
  }

 private:
  std::string path_, units_;
};

}  // namespace

PECTORA_STAGE(ScanFile, {.id = "scan.file", .version = "1.0",
                         .summary = "Reads a 3-D scan: FastSCAN text, PLY, STL, OBJ or VTK, as points or triangles",
                         .references = "FastSCAN user manual (ARANZ), export formats",
                         .outputs = {{"scan", {"Points", "Mesh"}}}})
