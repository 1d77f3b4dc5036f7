// segmenter.thorax: ribs, sternum, skin and pleura from a CT of the chest.
#include "plugins/segmenter/thorax/segment.h"

#include "kernel/stage/plugin.h"

using namespace pectora;

namespace {

class Thorax final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.real("bone_hu", settings_.boneHu, "HU", {80, 1000}, {120, 250},
           "Iso-value at which bone is outlined. Lower it for thin or osteoporotic bone.");
    v.real("smoothing", settings_.smoothingMm, "mm", {0, 4}, {0.5, 2},
           "Standard deviation of the smoothing before bone and lung are outlined. Raise it for noisy CTs.");
    v.integer("every_slice", settings_.everySlice, "slices", {1, 50}, {1, 5},
              "Levels of skin and pleura: 1 takes every slice, n every n-th.");
    v.choice("edge", edge_, {"subpixel", "paper"},
             "How the skin is found: \"subpixel\" where the value crosses half-way from air to skin; \"paper\" at the first "
             "pixel above a gradient threshold after strong smoothing, which lies 2 to 4 mm outside the skin.");
    v.real("skin_hu", settings_.skin.levelHu, "HU", {-900, -100}, {-600, -300}, "Level of the skin for edge = \"subpixel\".");
    v.real("paper_sigma", settings_.skin.paperSigmaPx, "px", {0.3, 10}, {1, 4},
           "Smoothing for edge = \"paper\", standard deviation in pixels.");
    v.real("paper_threshold", settings_.skin.paperThreshold, "", {0.01, 0.99}, {0.1, 0.5},
           "Gradient threshold for edge = \"paper\", as a part of the slice's greatest gradient.");
    v.real("lung_hu", settings_.pleura.lungLevelHu, "HU", {-900, -100}, {-600, -300}, "Level between lung and chest wall.");
    v.real("pleura_offset", settings_.pleura.offsetMm, "mm", {0, 10}, {0, 3},
           "How far the pleura lies inside the bone, where no lung shows it.");
    v.real("pleura_depth", settings_.pleura.deepestMm, "mm", {1, 40}, {4, 15},
           "Lung that lies farther than this inside the bony wall is not taken for the wall (heart, liver, mediastinum).");
    v.reals("bone_regions", regions_, "mm, HU", {-2000, 3000},
            "Boxes in which bone has a threshold of its own, seven numbers each: x, y and z of one corner and of the opposite one (LPS), "
            "and the threshold. For a bone that one threshold misses, or takes in too much of.");
    v.real("least_thickness", settings_.pleura.leastThicknessMm, "mm", {0.5, 30}, {2, 8},
           "Least distance between skin and pleura.");
  }

  Outputs run(const Inputs& inputs, Host& host) override {
    settings_.skin.edge = edge_ == "paper" ? thorax::Edge::paper : thorax::Edge::subpixel;
    if (regions_.size() % 7 != 0)
      throw Error("a box needs seven numbers: two corners and a threshold").of("bone_regions").given(std::to_string(regions_.size()) + " numbers");
    for (auto r = regions_.begin(); r != regions_.end(); r += 7) settings_.regions.push_back({{r[0], r[1], r[2]}, {r[3], r[4], r[5]}, r[6]});
    return {thorax::segment(inputs.get<Volume>("ct"), settings_, host)};
  }

 private:
  thorax::Settings settings_;
  std::string edge_ = "subpixel";
  std::vector<double> regions_;
};

}  // namespace

PECTORA_STAGE(Thorax, {
  .id = "segmenter.thorax", .version = "1.0",
  .summary = "Ribs (tracked and numbered), sternum, skin and pleura of a chest CT",
  .references = "Moreira et al., SPIE 2012 (skin, tracking of bone contours); Hu 1962 (moment invariants); "
                "Kuhn 1955 (assignment); Viterbi 1967 (spine and sternum).",
  .inputs = {{"ct", {"Volume"}}}, .outputs = {{"anatomy", {"Anatomy"}}}})
