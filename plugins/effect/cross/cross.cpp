// The oblique springs from each skin point to the pleura around its own pleura point: 24 in the paper.
#include "kernel/stage/wall_effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace {
using namespace pectora;

class Cross final : public Effect {
 public:
  void describe(Visitor& v) override { wall_.describe(v); }

  Contribution contribute(const Scene& scene, const System&) override {
    Contribution part;
    part.emptyBecause = WallSprings::emptyBecause(scene);
    if (!part.emptyBecause.empty()) return part;
    const CrossStiffness k = wall_.calibrate(scene, part.notes);
    double least = INFINITY, greatest = 0;
    for (int r = -k.rows; r <= k.rows; ++r) {
      for (int c = -k.columns; c <= k.columns; ++c) {
        if (r == 0 && c == 0) continue;  // the direct spring is an effect of its own
        const double stiffness = wall_.stiffness > 0 ? wall_.stiffness : k.at(r, c);
        part.stencil.push_back({Layer::outer, Layer::inner, r, c, stiffness});
        least = std::min(least, stiffness);
        greatest = std::max(greatest, stiffness);
      }
    }
    part.notes.push_back(fmt::format("k = {:.4g} to {:.4g} N/mm", least, greatest));
    return part;
  }

 private:
  WallSprings wall_;
};

}  // namespace

PECTORA_EFFECT(Cross, {.id = "effect.cross", .version = "1.0",
                       .summary = "The wall resists shearing: oblique springs from each skin point to the pleura, 24 in the paper",
                       .references = "Moreira et al., SPIE 2012; E = 1/2 k (l - l0)^2"})
