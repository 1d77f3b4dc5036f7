// Skin that stiffens as it is stretched.
#include "plugins/effect/j_curve/fung.h"

#include "kernel/stage/layer_effect.h"

#include <fmt/format.h>

#include <cmath>

namespace {
using namespace pectora;

class JCurve final : public Effect {
 public:
  void describe(Visitor& v) override {
    v.real("youngs_modulus", skin_.youngsModulus, "kPa", {1e-6, 1e9}, {20, 2000}, "Young's modulus of the skin at rest, as given to effect.stretch");
    v.real("skin_thickness", skin_.skinThickness, "mm", {1e-3, 20}, {0.5, 4}, "Thickness of the skin");
    v.real("exponent", exponent_, "", {0, 200}, {0, 30}, "b in exp(b strain), by which the stiffness grows");
    v.real("most", most_, "", {1, 1e6}, {2, 200}, "The stiffness grows up to so many times that at rest");
  }

  Contribution contribute(const Scene& scene, const System& system) override {
    Contribution part;
    if (exponent_ == 0 || most_ == 1) {
      part.emptyBecause = "the skin does not stiffen";
      return part;
    }
    const LayerStiffness k = skin_.calibrate(scene);
    std::vector<NodePair> pairs;
    std::vector<FungSpring> springs;
    const auto join = [&](int r, int c, int rows, int columns, double stiffness) {
      if (r + rows >= scene.rows || c + columns >= scene.columns) return;
      pairs.push_back({system.node(0, scene.index(r, c)), system.node(0, scene.index(r + rows, c + columns))});
      springs.push_back({stiffness, distance(scene.outer[scene.index(r, c)], scene.outer[scene.index(r + rows, c + columns)])});
    };
    for (int r = 0; r < scene.rows; ++r)
      for (int c = 0; c < scene.columns; ++c) {
        join(r, c, 1, 0, k.stretchRows);
        join(r, c, 0, 1, k.stretchColumns);
      }
    part.notes = {fmt::format("k = {:.4g} and {:.4g} N/mm at rest, twice that at a strain of {:.3g}", k.stretchRows, k.stretchColumns, std::log(2.0) / exponent_)};
    part.terms.push_back(makePairTerm("j_curve", system, std::move(pairs), makeFungLaw(std::move(springs), exponent_, most_), true));
    return part;
  }

 private:
  SkinSprings skin_;
  double exponent_ = 11, most_ = 100;
};

}  // namespace

PECTORA_EFFECT(JCurve, {.id = "effect.j_curve", .version = "1.0",
                        .summary = "Skin stiffens as it is stretched: more for effect.stretch's springs the longer they are",
                        .references = "Fung 1967: stress = c (exp(b strain) - 1); with compression = 0 in effect.stretch the skin bears tension alone"})
