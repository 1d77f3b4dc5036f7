// The wall's weight, in the posture of the CT and in that of the scan.
#include "plugins/effect/gravity/weight.h"

#include "kernel/stage/effect.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

const std::vector<std::string> kPostures{"supine", "prone", "upright", "none"};

// Where down is, in patient coordinates.
Vec3 down(const std::string& posture) {
  return posture == "supine" ? Vec3{0, 1, 0} : posture == "prone" ? Vec3{0, -1, 0} : posture == "upright" ? Vec3{0, 0, -1} : Vec3{};
}

class Gravity final : public Effect {
 public:
  void describe(Visitor& v) override {
    v.choice("ct_posture", ctPosture_, kPostures, "How the patient lay in the CT; its shape is taken as at rest under this weight, and the shape without it is found first");
    v.choice("posture", posture_, kPostures, "How the patient stands or lies in the scan");
    v.real("acceleration", acceleration_, "m/s2", {0, 100}, {0, 10}, "Acceleration of gravity");
  }

  Contribution contribute(const Scene&, const System& system) override {
    Contribution part;
    if (acceleration_ == 0 || (ctPosture_ == "none" && posture_ == "none")) {
      part.emptyBecause = "there is no weight";
      return part;
    }
    double mass = 0;
    for (const double m : system.mass) mass += m;
    part.notes = {fmt::format("{:.2f} kg, {} in the CT and {} after it", mass, ctPosture_, posture_)};
    if (posture_ != "none") part.terms.push_back(makeWeightTerm(system, down(posture_) * acceleration_));
    if (ctPosture_ != "none") 
      part.loadInCt = [&system, weight = down(ctPosture_) * acceleration_](double factor) { return makeWeightTerm(system, weight * factor); };
    return part;
  }

 private:
  std::string ctPosture_ = "supine", posture_ = "upright";
  double acceleration_ = 9.81;
};

}  // namespace

PECTORA_EFFECT(Gravity, {.id = "effect.gravity", .version = "1.0",
                         .summary = "The wall's weight: a patient lies in the CT and stands in the scan",
                         .references = "E = -m g . x; Sellier, Finite Elements in Analysis and Design 2011, for the shape without weight"})
