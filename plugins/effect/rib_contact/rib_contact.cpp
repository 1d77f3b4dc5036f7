// The pleura stays on its side of the ribs, cartilages and sternum.
#include "plugins/effect/common/pair_term.h"

#include "kernel/stage/effect.h"

#include <fmt/format.h>

#include <algorithm>

namespace {
using namespace pectora;

constexpr double kGlued = 1e-9;   // mm: such a point sits on the body and cannot go through it

class RibContact final : public Effect {
 public:
  void describe(Visitor& v) override {
    v.real("radius", radius_, "mm", {0, 50}, {2, 10}, "From a body's centre line to its inner side; a pleura point that is nearer at rest may stay as near");
    v.real("stiffness", stiffness_, "N/mm", {1e-9, 1e12}, {0.1, 100}, "Force over the depth to which a point comes into the body");
  }

  Contribution contribute(const Scene& scene, const System& system) override {
    Contribution part;
    std::vector<NodePair> pairs;
    std::vector<Obstacle> obstacles;
    for (std::size_t j = 0; j < scene.anchors.size(); ++j) {
      const Anchor& anchor = scene.anchors[j];
      if (anchor.body == BodyKind::still || anchor.isOnSkin) continue;
      const Vec3 away = scene.inner[anchor.point] - anchor.rest;
      if (norm(away) < kGlued) continue;
      pairs.push_back({system.node(system.layers - 1, anchor.point), system.anchorNode(j)});
      obstacles.push_back({normalized(away), std::min(radius_, norm(away)), stiffness_});
    }
    if (pairs.empty()) {
      part.emptyBecause = "no pleura point lies beside a rib, cartilage or the sternum";
      return part;
    }
    part.notes = {fmt::format("{} pairs of pleura and bone", pairs.size())};
    part.terms.push_back(makePairTerm("rib_contact", system, std::move(pairs), makeObstacleLaw(obstacles), false));
    return part;
  }

 private:
  double radius_ = 5, stiffness_ = 5;
};

}  // namespace

PECTORA_EFFECT(RibContact, {.id = "effect.rib_contact", .version = "1.0",
                            .summary = "Ribs, cartilages and sternum are in the way: the pleura does not pass through them",
                            .references = "E = 1/2 k min(0, gap)^2, the gap along the direction from body to pleura at rest"})
