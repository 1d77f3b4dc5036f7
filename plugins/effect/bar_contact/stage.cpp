// The pleura stays in front of the bar.
#include "plugins/effect/bar_contact/bar_front.h"
#include "plugins/effect/common/pair_term.h"

#include "kernel/stage/effect.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class BarContact final : public Effect {
 public:
  void describe(Visitor& v) override {
    v.real("stiffness", stiffness_, "N/mm", {1e-9, 1e12}, {0.1, 100}, "Force over the depth to which a point of the pleura comes behind the bar's front");
  }

  Contribution contribute(const Scene& scene, const System& system) override {
    Contribution part;
    std::vector<NodePair> pairs;
    std::vector<Obstacle> obstacles;
    for (int i = 0; i < scene.points(); ++i) {
      pairs.push_back({system.node(system.layers - 1, i), system.rest.size() + std::size_t(i)});
      obstacles.push_back({{0, -1, 0}, 0, stiffness_});   // the bar pushes forward
      part.guides.push_back(farBehind(scene.inner[i]));
    }
    // A row of points counts as under the bar if it is the nearest one to it.
    part.steering.guides = [inner = scene.inner, margin = 0.5 * scene.rowSpacing](const Plan& plan, double t, const std::vector<Vec3>&) { return barFront(plan, t, inner, margin); };
    part.notes = {"between the bar's hinges, over its width and half a row to each side"};
    part.terms.push_back(makePairTerm("bar_contact", system, std::move(pairs), makeObstacleLaw(obstacles), false));
    return part;
  }

 private:
  double stiffness_ = 5;
};

}  // namespace

PECTORA_EFFECT(BarContact, {.id = "effect.bar_contact", .version = "1.0",
                            .summary = "The bar is in the way: the inner wall under it is pushed forwards and does not pass through it",
                            .references = "E = 1/2 k min(0, gap)^2, the gap from the bar's front forwards"})
