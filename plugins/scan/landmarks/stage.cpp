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
    v.texts("names", names_, TextRole::plain, "In place of a file: the landmarks' names");
    v.reals("positions", positions_, "mm", {-1e6, 1e6}, "In place of a file: x, y, z of each name, one after another");
  }

  Outputs run(const Inputs&, Host&) override {
    if (path_.empty() && !names_.empty()) return {fromLists()};
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
  std::shared_ptr<const Landmarks> fromLists() const {
    if (positions_.size() != 3 * names_.size())
      throw Error("each name needs three numbers").of("positions").given(std::to_string(positions_.size()) + " numbers").allowed(std::to_string(3 * names_.size()));
    auto landmarks = std::make_shared<Landmarks>();
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (names_[i].empty() || landmarks->find(names_[i])) throw Error("every landmark needs a name of its own").of("names").given(names_[i]);
      landmarks->points.push_back({names_[i], {positions_[3 * i], positions_[3 * i + 1], positions_[3 * i + 2]}});
    }
    return landmarks;
  }

  std::string path_, set_;
  std::vector<std::string> names_;
  std::vector<double> positions_;
};

}  // namespace

PECTORA_STAGE(LandmarkFile, {.id = "scan.landmarks", .version = "1.0",
                             .summary = "Landmarks placed on the CT's skin or on the scan, from a text file or given by hand",
                             .outputs = {{"landmarks", {"Landmarks"}}}})
