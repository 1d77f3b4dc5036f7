#include "plugins/scan/clean/clean.h"

#include "kernel/stage/plugin.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class Clean final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.real("duplicates", settings_.duplicateDistance, "mm", {0, 10}, {0, 0.5}, "Of points nearer together than this one stays; 0: all stay");
    v.integer("neighbours", settings_.neighbours, "", {4, 200}, {8, 50}, "Points around a point that say what is usual there");
    v.real("outliers", settings_.outlierFactor, "", {0, 100}, {2, 10}, "Points that lie further from their neighbours than this many robust standard deviations above the median leave; 0: none does");
    v.flag("normals", settings_.estimateNormals, "Estimate outward normals where the scan has none");
  }

  Outputs run(const Inputs& inputs, Host& host) override {
    const auto scan = inputs.get<Points>("scan");
    Cleaned made = clean(*scan, settings_, [&](double fraction) {
      host.checkCancel();
      host.progress(fraction, "cleaning the scan");
    });
    const std::size_t removed = made.notFinite + made.duplicates + made.outliers;
    const std::string account = fmt::format("of {} points {} left: {} not finite, {} duplicates, {} outliers; normals {}", scan->points.size(), removed, made.notFinite, made.duplicates,
                                            made.outliers, made.estimatedNormals ? "estimated" : made.points.normals.empty() ? "absent" : "kept");
    // A tenth of a scan is more than dust.
    if (10 * removed > scan->points.size()) host.warn(account);
    else host.info(account);
    return {std::make_shared<Points>(std::move(made.points))};
  }

 private:
  CleanSettings settings_;
};

}  // namespace

PECTORA_STAGE(Clean, {.id = "scan.clean", .version = "1.0",
                      .summary = "Takes outliers and duplicate points out of a scanned cloud and finds its normals",
                      .references = "Rusu et al., Robotics and Autonomous Systems 2008 (outliers); Hoppe et al., SIGGRAPH 1992 (normals)",
                      .inputs = {{"scan", {"Points"}}},
                      .outputs = {{"cleaned", {"Points"}}}})
