#include "plugins/report/files/cage_picture.h"
#include "plugins/report/files/course.h"
#include "plugins/report/files/metrics_table.h"
#include "plugins/report/files/slice_picture.h"
#include "plugins/report/files/surface_picture.h"

#include "plugins/report/common/atomic_file.h"
#include "plugins/report/common/mesh_files.h"
#include "plugins/report/common/record_json.h"

#include "kernel/stage/plugin.h"
#include "kernel/value/comparison.h"
#include "kernel/value/indices.h"
#include "kernel/value/levels.h"
#include "kernel/value/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace {
using namespace pectora;

class Files final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.text("path", path_, TextRole::outputPath, "Folder to write into; made if it does not exist");
    v.integer("slices", slices_, "", {0, 10000}, {0, 60}, "Number of slice pictures with contours, spread over the CT");
    v.real("color_limit", colorLimit_, "mm", {0, 500}, {0, 30}, "End of the distance maps' colour bar; 0: a round figure that holds 98 % of the points");
  }

  Outputs run(const Inputs& inputs, Host& host) override {
    if (path_.empty()) throw Error("a folder to write into is needed").of("path");
    makeFolder(path_);
    auto report = std::make_shared<Report>();
    report->folder = path_;
    report_ = report.get();

    // Everything that was handed in, once, for facts and provenance.
    std::vector<Handle> all;
    for (const char* port : {"ct", "anatomy", "cage", "scene", "plan", "motion", "registration", "comparisons", "scan"})
      all.insert(all.end(), inputs.handles(port).begin(), inputs.handles(port).end());
    writePictures(inputs, host);
    writeMeshes(inputs);
    writeComparisons(inputs);
    writeMetrics(inputs);
    writeSummary(inputs, all);
    return {report};
  }

 private:
  std::string file(const std::string& name) {
    report_->files.push_back(name);
    return path_ + "/" + name;
  }
  // What an earlier run left in greater number would pass for this one's.
  void removeOld(const std::string& beginning, const char* extension) const {
    const std::filesystem::path begin = path_ + "/" + beginning;
    for (const auto& entry : std::filesystem::directory_iterator(begin.parent_path()))
      if (entry.path().filename().string().starts_with(begin.filename().string()) && entry.path().extension() == extension) std::filesystem::remove(entry.path());
  }
  static FileNote note(const Inputs& inputs, const char* port) { return {inputs.handles(port).front().record->key}; }

  void writePictures(const Inputs& inputs, Host& host) {
    const auto ct = inputs.get<Volume>("ct");
    const auto anatomy = inputs.get<Anatomy>("anatomy");
    const auto plan = inputs.get<Plan>("plan");
    const auto cage = plan ? plan->cage : inputs.get<RibCage>("cage");
    if (ct && anatomy && slices_ > 0) {
      makeFolder(path_ + "/slices");
      removeOld("slices/slice_", ".png");
      const int total = ct->grid.size[2], count = std::min(slices_, total);
      for (int i = 0; i < count; ++i) {
        host.checkCancel();
        host.progress(double(i) / count, "drawing slices");
        const int slice = count > 1 ? int(std::int64_t(i) * (total - 1) / (count - 1)) : total / 2;
        slicePicture(*ct, *anatomy, cage.get(), slice).write(file(fmt::format("slices/slice_{:04}.png", slice)));
      }
    }
    if (cage) cagePicture(*cage, plan.get()).write(file("rib_cage.png"));
  }

  void writeMeshes(const Inputs& inputs) {
    if (const auto motion = inputs.get<Motion>("motion")) {
      std::map<std::string, std::shared_ptr<const Value>> parts;
      for (auto& [name, part] : motion->parts()) parts[name] = part;
      const auto& before = dynamic_cast<const Mesh&>(*parts.at("before"));
      const auto& after = dynamic_cast<const Mesh&>(*parts.at("after"));
      writeFile(file("before.ply"), plyBytes(before, note(inputs, "motion")));
      writeFile(file("after.ply"), plyBytes(after, note(inputs, "motion")));
      writeFile(file("scene.vtp"), vtpBytes(after, note(inputs, "motion")));
      surfacePicture(before, "", 0, "Before", {}).write(file("before.png"));
      surfacePicture(after, "", 0, "Predicted", {}).write(file("after.png"));
      if (!motion->moments.empty()) writeCourse(*motion, note(inputs, "motion"));
    }
    if (const auto plan = inputs.get<Plan>("plan"))
      writeFile(file("bar.ply"), plyBytes(barMesh(plan->bars), note(inputs, "plan")));
  }

  // The way in time: a table, and the skin at every moment.
  void writeCourse(const Motion& motion, const FileNote& note) {
    writeFile(file("course.csv"), courseCsv(motion));
    makeFolder(path_ + "/course");
    removeOld("course/skin_", ".vtp");
    std::vector<std::string> names;
    for (const Moment& moment : motion.moments) {
      names.push_back(fmt::format("course/skin_{:04}.vtp", names.size()));
      writeFile(file(names.back()), vtpBytes(displacedSkin(*motion.scene, moment.outer), note));
    }
    writeFile(file("course.pvd"), coursePvd(motion, names));
  }

  void writeComparisons(const Inputs& inputs) {
    for (const Handle& handle : inputs.handles("comparisons")) {
      const auto& comparison = dynamic_cast<const Comparison&>(*handle.value);
      const FileNote note{handle.record->key};
      std::vector<double> distances;
      if (const auto* mesh = dynamic_cast<const Mesh*>(comparison.sample.get())) {
        writeSurface(comparison.name, *mesh, note);
        distances = fieldValues(mesh->fields);
      } else if (const auto* points = dynamic_cast<const Points*>(comparison.sample.get())) {
        writeSurface(comparison.name, *points, note);
        distances = fieldValues(points->fields);
      }
      if (comparison.reference) writeSurface(comparison.name + "_reverse", *comparison.reference, note);
      const double limit = colorLimit_ > 0 ? colorLimit_ : roundLimit(distances);
      std::string title = comparison.name;
      std::replace(title.begin(), title.end(), '_', ' ');
      std::vector<std::string> captions{caption("whole overlap", comparison.overlap), caption("pit region", comparison.pit)};
      for (const ComparedRegion& region : comparison.regions) captions.push_back(caption(region.name, region.distances));
      surfacePicture(*comparison.sample, "distance", limit, "Signed distance: " + title, captions).write(file(comparison.name + ".png"));
      std::string csv = "low_mm,high_mm,points\n";
      for (std::size_t i = 0; i < comparison.histogram.counts.size(); ++i) {
        const double low = comparison.histogram.low + double(i) * comparison.histogram.binWidth;
        csv += fmt::format("{:g},{:g},{}\n", low, low + comparison.histogram.binWidth, comparison.histogram.counts[i]);
      }
      writeFile(file(comparison.name + "_histogram.csv"), csv);
    }
  }

  // With its figures point by point, for ParaView and Slicer (VTP), and for MeshLab and CloudCompare (PLY).
  template <class Surface>
  void writeSurface(const std::string& name, const Surface& surface, const FileNote& note) {
    writeFile(file(name + ".vtp"), vtpBytes(surface, note));
    writeFile(file(name + ".ply"), plyBytes(surface, note));
  }

  static std::vector<double> fieldValues(const std::vector<PointField>& fields) {
    for (const PointField& f : fields)
      if (f.name == "distance") return f.values;
    return {};
  }

  static std::string caption(const std::string& region, const DistanceStatistics& s) {
    if (s.count == 0) return region + ": no points";
    return fmt::format("{}: {} points, mean {:+.2f}, SD {:.2f}, RMS {:.2f}, min {:+.2f}, max {:+.2f} mm (signed)", region, s.count, s.mean, s.sd, s.rms, s.min, s.max);
  }

  // A row for every level: before, predicted, and on the scan what shows on the skin.
  void writeMetrics(const Inputs& inputs) {
    const auto anatomy = inputs.get<Anatomy>("anatomy");
    if (!anatomy || anatomy->metrics.empty()) return;
    states_ = {{"before", anatomy->metrics}};
    const auto plan = inputs.get<Plan>("plan");
    const auto motion = inputs.get<Motion>("motion");
    std::vector<LevelMetrics> planned = plan ? plannedLevels(*anatomy, plan->motion) : std::vector<LevelMetrics>();
    if (motion) {
      std::shared_ptr<const Value> after;
      for (auto& [name, part] : motion->parts())
        if (name == "after") after = part;
      const auto& skin = dynamic_cast<const Mesh&>(*after);
      planned = withSkin(std::move(planned), *anatomy, [&](double z, Vec3 vertebra, double half) { return frontAt(skin, z, vertebra, half); });
    }
    if (!planned.empty()) states_.emplace_back("predicted", std::move(planned));
    if (inputs.has("scan")) {
      std::vector<LevelMetrics> outside;
      for (const LevelMetrics& level : anatomy->metrics) outside.emplace_back().z = level.z;
      const auto mesh = inputs.get<Mesh>("scan");
      const auto points = inputs.get<Points>("scan");
      states_.emplace_back("scan", withSkin(std::move(outside), *anatomy, [&](double z, Vec3 vertebra, double half) {
                             return mesh ? frontAt(*mesh, z, vertebra, half) : frontAt(*points, z, vertebra, half);
                           }));
    }
    writeFile(file("metrics.csv"), metricsCsv(states_));
  }

  void writeSummary(const Inputs& inputs, const std::vector<Handle>& all) {
    const std::string path = file("summary.json");
    Json json;
    json["about"] = "Pectora: research software, not a medical device";
    json["coordinates"] = "DICOM patient coordinates (LPS), mm";
    for (const char* port : {"ct", "anatomy", "cage", "scene", "plan", "motion"})
      if (inputs.has(port)) json[port] = factsJson(*inputs.handles(port).front().value);
    for (const Handle& handle : inputs.handles("registration"))
      json["registration"][dynamic_cast<const Registration&>(*handle.value).method] = factsJson(*handle.value);
    if (const auto scene = inputs.get<Scene>("scene")) {
      Json effects = Json::array();
      for (const auto& call : scene->effects) effects.push_back(call->id);
      json["effects"] = std::move(effects);
    }
    Json comparisons = Json::object();
    for (const Handle& handle : inputs.handles("comparisons"))
      comparisons[dynamic_cast<const Comparison&>(*handle.value).name] = factsJson(*handle.value);
    json["comparisons"] = std::move(comparisons);
    if (const auto anatomy = inputs.get<Anatomy>("anatomy")) {
      if (const LevelMetrics* level = anatomy->deepestLevel()) json["metrics"] = metricsJson(states_, level->z);
      json["doubts"] = Json::array();
      for (const SliceRange& range : anatomy->ranges)
        json["doubts"].push_back({{"what", range.what}, {"z_low_mm", range.low}, {"z_high_mm", range.high}, {"meaning", range.meaning}});
    }
    json["files"] = report_->files;
    json["provenance"] = provenanceJson(all);
    json["timing"] = timingJson(all);
    writeFile(path, json.dump(2) + "\n");
  }

  std::string path_;
  int slices_ = 20;
  double colorLimit_ = 0;
  Report* report_ = nullptr;
  MetricStates states_;
};

}  // namespace

PECTORA_STAGE(Files, {.id = "report.files", .version = "1.0",
                      .summary = "Writes the summary, meshes, histograms and pictures of a run into a folder",
                      .inputs = {{"ct", {"Volume"}, true}, {"anatomy", {"Anatomy"}, true}, {"cage", {"RibCage"}, true},
                                 {"scene", {"Scene"}, true}, {"plan", {"Plan"}, true}, {"motion", {"Motion"}, true},
                                 {.name = "registration", .kinds = {"Registration"}, .isList = true},
                                 {.name = "comparisons", .kinds = {"Comparison"}, .isList = true},
                                 {"scan", {"Mesh", "Points"}, true}},
                      .outputs = {{"report", {"Report"}}},
                      .isCacheable = false})
