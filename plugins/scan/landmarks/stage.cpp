#include "plugins/scan/landmarks/read_landmarks.h"

#include "kernel/stage/plugin.h"

#include <filesystem>
#include <fstream>
#include <sstream>

namespace {
using namespace pectora;

class LandmarkFile final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.text("path", path_, TextRole::inputPath, "Text file with a line \"name, x, y, z\" a landmark, mm");
    v.choice("set", set_, {"", "ct", "scan"}, "Which columns to take from a file that holds both surfaces' landmarks (ct_x ... scan_z)");
  }

  Outputs run(const Inputs&, Host&) override {
    std::ifstream file(path_, std::ios::binary);
    if (path_.empty() || !file || std::filesystem::is_directory(path_)) throw Error("the file cannot be read").of("path").given(path_);
    std::ostringstream text;
    text << file.rdbuf();
    try {
      return {std::make_shared<Landmarks>(readLandmarks(text.str(), set_))};
    } catch (Error& error) {
      throw error.of(std::filesystem::path(path_).filename().string());
    }
  }

 private:
  std::string path_, set_;
};

}  // namespace

PECTORA_STAGE(LandmarkFile, {.id = "scan.landmarks", .version = "1.0",
                             .summary = "Reads landmarks placed on the CT's skin or on the scan from a text file",
                             .outputs = {{"landmarks", {"Landmarks"}}}})
