#include "plugins/loader/dicom/load.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/plugin.h"

namespace {
using namespace pectora;

class LoadDicom final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.text("path", path_, TextRole::inputPath, "Folder of the CT (searched with its sub-folders), a DICOMDIR, or one file");
    v.texts("files", files_, TextRole::inputPath, "The files themselves, instead of path");
    v.text("series", series_, TextRole::plain, "Which series, if there are several: its number or code in the log's listing, or its SeriesInstanceUID; empty: the axial CT with the most slices");
    v.flag("resample_tilt", resampleTilt_, "Resample a scan whose gantry was tilted onto a rectangular grid, rather than refuse it");
    v.real("timeout", timeout_, "s", {0.1, 3600}, {10, 300}, "Longest time that one file may take");
  }

  Outputs run(const Inputs&, Host& host) override {
    if (path_.empty() == files_.empty()) throw Error(path_.empty() ? "a folder or file is needed" : "give either path or files").of("path");
    const auto paths = files_.empty() ? dicom::filesOf(path_) : files_;
    const dicom::LoadOptions options{.series = series_, .resamplesTilt = resampleTilt_,
                                     .helpers = {.program = host.pluginFolder() + "/pectora-dicom", .processes = threads(), .timeoutSeconds = timeout_}};
    return {std::make_shared<Volume>(dicom::load(paths, options, host))};
  }

 private:
  std::string path_, series_;
  std::vector<std::string> files_;
  bool resampleTilt_ = false;
  double timeout_ = 60;
};

}  // namespace

PECTORA_STAGE(LoadDicom, {.id = "loader.dicom", .version = "1.0",
                          .summary = "Reads an axial CT series from DICOM files",
                          .references = "DICOM PS3.3 (C.7.6.2 Image Plane, C.8.2 CT), PS3.5 (transfer syntaxes); decoded by GDCM",
                          .outputs = {{"ct", {"Volume"}}}})
