#include "plugins/report/truth/truth_files.h"

#include "plugins/report/common/atomic_file.h"
#include "plugins/report/common/mesh_files.h"
#include "plugins/report/common/record_json.h"

#include "kernel/stage/plugin.h"
#include "kernel/value/comparison.h"

namespace {
using namespace pectora;

class TruthFiles final : public Stage {
 public:
  void describe(Visitor& v) override { v.text("path", path_, TextRole::outputPath, "Folder to write into; made if it does not exist"); }

  Outputs run(const Inputs& inputs, Host& host) override {
    if (path_.empty()) throw Error("a folder to write into is needed").of("path");
    const auto truth = inputs.get<Truth>("truth");
    const Handle& handle = inputs.handles("truth").front();
    const FileNote note{handle.record->key};
    auto report = std::make_shared<Report>();
    report->folder = path_;
    const auto write = [&](const std::string& name, const std::string& bytes) {
      host.checkCancel();
      writeFile(path_ + "/" + name, bytes);
      report->files.push_back(name);
    };
    write("labels.nrrd", nrrdBytes(*truth->labels, note.recordKey));
    write("centerlines.csv", centerlinesCsv(*truth));
    write("metrics.csv", metricsCsv(*truth->anatomy));
    write("skin_before.ply", plyBytes(*truth->skinBefore, note));
    write("skin_after.ply", plyBytes(*truth->skinAfter, note));
    write("pleura.ply", plyBytes(*truth->pleura, note));
    if (const auto scan = inputs.get<Points>("scan")) {
      write("scan.txt", fastScanText(*scan));
      write("scan.ply", plyBytes(*scan, note));
    }
    if (inputs.has("ct_landmarks") && inputs.has("scan_landmarks"))
      write("landmarks.csv", landmarksCsv(*inputs.get<Landmarks>("ct_landmarks"), *inputs.get<Landmarks>("scan_landmarks")));
    const auto point = [](Vec3 p) { return Json{p.x, p.y, p.z}; };
    const Sternum& s = truth->anatomy->sternum;
    Json json{{"about", "Truth of a phantom patient; LPS, mm"},
              {"truth", factsJson(*truth)},
              {"anatomy", factsJson(*truth->anatomy)},
              {"sternum", {{"jugular_notch", point(s.jugularNotch)}, {"manubriosternal_joint", point(s.manubriosternalJoint)},
                           {"xiphisternal_joint", point(s.xiphisternalJoint)}, {"deepest", point(s.deepest)},
                           {"tilt_deg", s.tiltDeg}, {"torsion_deg", s.torsionDeg}}},
              {"files", report->files},
              {"provenance", provenanceJson({handle})}};
    write("truth.json", json.dump(2) + "\n");
    return {report};
  }

 private:
  std::string path_;
};

}  // namespace

PECTORA_STAGE(TruthFiles, {.id = "report.truth", .version = "1.0",
                           .summary = "Writes what a phantom knows of itself: labels, centrelines, meshes, metrics, scan and landmarks",
                           .inputs = {{"truth", {"Truth"}}, {"scan", {"Points"}, true}, {"ct_landmarks", {"Landmarks"}, true}, {"scan_landmarks", {"Landmarks"}, true}},
                           .outputs = {{"report", {"Report"}}},
                           .isCacheable = false})
