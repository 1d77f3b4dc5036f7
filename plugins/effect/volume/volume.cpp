// The cells between the layers keep their volume, which springs alone do not.
#include "plugins/effect/common/cells.h"

#include "kernel/stage/wall_effect.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class Volume final : public Effect {
 public:
  void describe(Visitor& v) override {
    v.real("youngs_modulus", youngsModulus_, "kPa", {1e-6, 1e9}, {1, 100}, "Young's modulus of the tissue between skin and pleura");
    v.real("poissons_ratio", poissonsRatio_, "", {0.25, 0.4999}, {0.3, 0.49},
           "Poisson's ratio of the tissue; springs alone have 1/4. Give effect.direct and effect.cross the same");
  }

  // Springs that aim at E_s = 2.5 mu have the moduli lambda = mu; 1/2 kappa V (J - 1)^2 adds what is missing to lambda.
  Contribution contribute(const Scene& scene, const System& system) override {
    const double mu = youngsModulus_ * 1e-3 / (2 * (1 + poissonsRatio_));
    const double kappa = mu * (4 * poissonsRatio_ - 1) / (1 - 2 * poissonsRatio_);
    Contribution part;
    part.emptyBecause = WallSprings::emptyBecause(scene);
    if (!part.emptyBecause.empty()) return part;
    if (!(kappa > 0)) {
      part.emptyBecause = "springs alone have a Poisson's ratio of 0.25";
      return part;
    }
    part.notes = {fmt::format("kappa = {:.4g} kPa; the springs of the wall should aim at E = {:.4g} kPa, which they do with poissons_ratio = {:.4g}",
                              1e3 * kappa, 2.5e3 * mu, poissonsRatio_)};
    part.terms.push_back(makeVolumeTerm("volume", system, kappa));
    return part;
  }

 private:
  double youngsModulus_ = 10;
  double poissonsRatio_ = 0.45;
};

}  // namespace

PECTORA_EFFECT(Volume, {.id = "effect.volume", .version = "1.0",
                        .summary = "The wall keeps its volume: each cell between the layers resists growing and shrinking",
                        .references = "E = 1/2 kappa V (J - 1)^2, J the cell's volume over that at rest"})
