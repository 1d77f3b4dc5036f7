// The wall's mass and damping, for scenes that ask how it moves in time.
#include "kernel/stage/effect.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class Inertia final : public Effect {
 public:
  void describe(Visitor& v) override {
    v.real("duration", duration_, "s", {0, 1e4}, {0, 5}, "How long the wall is followed from the moment that the bar begins to lift; 0: its shape at rest is all that is asked for");
    v.real("lifting", lifting_, "s", {0, 1e4}, {0, 2}, "Time in which the bar comes to its place, starting and stopping softly; 0: at once");
    v.real("damping", damping_, "1/s", {0, 1e6}, {0, 200}, "Damping c in a = F/m - c v: a swing of angular frequency w has the damping ratio c / (2 w)");
    v.real("interval", interval_, "s", {1e-6, 1e3}, {0.005, 0.1}, "Time between the moments that are kept");
  }

  Contribution contribute(const Scene&, const System& system) override {
    Contribution part;
    if (duration_ == 0) {
      part.emptyBecause = "the scene asks for no motion in time (duration = 0)";
      return part;
    }
    part.dynamics = {duration_, lifting_, interval_, damping_};
    double mass = 0;
    for (const double m : system.mass) mass += m;
    part.notes = {fmt::format("{:.2f} kg through {:g} s, the bar in place after {:g} s, c = {:g} 1/s", mass, duration_, lifting_, damping_)};
    return part;
  }

 private:
  double duration_ = 0, lifting_ = 0.3, damping_ = 30, interval_ = 0.02;
};

}  // namespace

PECTORA_EFFECT(Inertia, {.id = "effect.inertia", .version = "1.0",
                         .summary = "The wall moves in time: its mass and damping, with the model's densities",
                         .references = "Moreira et al., SPIE 2012, eq. 2: a = F / m - c v"})
