#include "plugins/comparer/surface/compare.h"

#include "kernel/stage/plugin.h"

namespace {
using namespace pectora;

class Surface final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.text("name", settings_.name, TextRole::plain, "Name of the comparison in reports, letters, digits and _");
    v.real("max_distance", settings_.maxDistance, "mm", {0.1, 1000}, {10, 80}, "Points further away than this have no counterpart and are left out");
    v.real("pit_threshold", settings_.pitThreshold, "mm", {0, 100}, {1, 6}, "The pit is where the reference differs from unchanged by more than this, the hollow where unchanged lies deeper than this behind a string over its front");
    v.real("pit_margin", settings_.pitMargin, "mm", {0, 200}, {0, 30}, "What lies within this of pit and hollow belongs to them, too");
    v.real("bin_width", settings_.binWidth, "mm", {0.01, 100}, {0.1, 2}, "Width of the histogram's bins");
    v.choice("mode", mode_, {"full", "paper"}, "full: points beyond a border or too far are left out; paper: every point counts, as in the paper's Table 1");
    v.flag("both_ways", settings_.bothWays, "Measure from the reference to the sample, too, if that is a mesh: symmetric mean, RMS, HD95 and Hausdorff distance");
    v.texts("regions", regions_, TextRole::plain, "Regions of one's own: \"NAME = ball X Y Z RADIUS\" or \"NAME = box X0 X1 Y0 Y1 Z0 Z1\", mm");
  }

  Outputs run(const Inputs& inputs, Host& host) override {
    if (settings_.name.empty() || settings_.name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") != std::string::npos)
      throw Error("the name becomes part of file names").of("name").given(settings_.name).allowed("letters, digits and _");
    settings_.isPaper = mode_ == "paper";
    for (const std::string& text : regions_) settings_.regions.push_back(parseRegion(text));
    const auto reference = inputs.get<Mesh>("reference");
    const auto unchanged = inputs.get<Mesh>("unchanged");
    const auto copied = inputs.get<Mesh>("copied");
    const auto poll = [&](double fraction) {
      host.checkCancel();
      host.progress(fraction, "measuring distances");
    };
    return {std::make_shared<Comparison>(
        compareSurfaces(inputs.handles("sample").front().value, {*reference, unchanged.get(), copied.get()}, settings_, poll))};
  }

 private:
  CompareSettings settings_;
  std::string mode_ = "full";
  std::vector<std::string> regions_;
};

}  // namespace

PECTORA_STAGE(Surface, {.id = "comparer.surface", .version = "1.0",
                        .summary = "Signed distances between two surfaces, over overlap, pit, hollow and regions, against nothing changed and skin that copies bone",
                        .references = "Baerentzen and Aanaes, IEEE TVCG 2005 (sign); Moreira et al., SPIE 2012 (mean, SD, min, max)",
                        .inputs = {{"sample", {"Points", "Mesh"}}, {"reference", {"Mesh"}}, {"unchanged", {"Mesh"}, true}, {"copied", {"Mesh"}, true}},
                        .outputs = {{"comparison", {"Comparison"}}}})
