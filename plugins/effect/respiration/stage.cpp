// The CT is taken in full inspiration, the scan in quiet breathing.
#include "plugins/effect/respiration/breathing.h"

#include "kernel/stage/effect.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class Respiration final : public Effect {
 public:
  void describe(Visitor& v) override {
    v.real("exhaled", exhaled_, "", {-1.5, 1.5}, {-1, 1}, "How far the patient has breathed out between CT and scan: 1 from full inspiration to the end of a quiet expiration, negative in");
  }

  Contribution contribute(const Scene& scene, const System&) override {
    Contribution part;
    if (exhaled_ == 0 || scene.cage->ribs.empty()) {
      part.emptyBecause = exhaled_ == 0 ? "CT and scan are taken in the same phase" : "no rib was found";
      return part;
    }
    const Breathing breathing(*scene.cage, exhaled_);
    part.notes = {fmt::format("the sternum goes {:.1f} mm back and {:.1f} mm down", breathing.sternum().y, -breathing.sternum().z)};
    part.steering.displacement = [breathing](const Plan&, const Anchor& anchor) { return breathing.displacement(anchor); };
    return part;
  }

 private:
  double exhaled_ = 0.5;
};

}  // namespace

PECTORA_EFFECT(Respiration, {.id = "effect.respiration", .version = "1.0",
                             .summary = "The patient breathes: ribs turn like pump and bucket handles between CT and scan",
                             .references = "Wilson et al., J Appl Physiol 1987: 11 and 13 degrees at rib 3, 7 and 10 at rib 7, from full inspiration to quiet expiration"})
