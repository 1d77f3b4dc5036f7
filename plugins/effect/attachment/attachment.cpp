// Each pleura point hangs on the ribs, cartilages and sternum next to it; the skin's edge on the skin beyond.
#include "kernel/stage/effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace {
using namespace pectora;

class Attachment final : public Effect {
 public:
  void describe(Visitor& v) override {
    v.real("youngs_modulus", youngsModulus_, "kPa", {1e-6, 1e9}, {10, 500},
           "Young's modulus of the intercostal tissue: a spring is a strut of it with the section of one cell");
    v.real("stiffness", stiffness_, "N/mm", {0, 1e12}, {0, 10}, "Spring constant given by hand; 0: from Young's modulus");
  }

  Contribution contribute(const Scene& scene, const System& system) override {
    Contribution part;
    if (scene.anchors.empty()) {
      part.emptyBecause = "no rib, cartilage or sternum was found to hold the pleura";
      return part;
    }
    // A strut of length L and section A has k = E A / L; one shorter than 1 mm counts as 1 mm. The abdomen behind its
    // wall, and the skin beyond the model's edge, give way like a strut as long as the wall is thick.
    const double area = scene.rowSpacing * scene.columnSpacing;
    double least = INFINITY, greatest = 0;
    for (std::size_t j = 0; j < scene.anchors.size(); ++j) {
      const Anchor& anchor = scene.anchors[j];
      const double length = anchor.body == BodyKind::still ? scene.thickness : std::max(1.0, distance(anchor.rest, scene.inner[anchor.point]));
      const double k = stiffness_ > 0 ? stiffness_ : youngsModulus_ * 1e-3 * area / length;
      part.springs.push_back({system.node(anchor.isOnSkin ? 0 : system.layers - 1, anchor.point), system.anchorNode(j), k});
      least = std::min(least, k);
      greatest = std::max(greatest, k);
    }
    part.notes = {fmt::format("k = {:.4g} to {:.4g} N/mm", least, greatest)};
    return part;
  }

 private:
  double youngsModulus_ = 60;
  double stiffness_ = 0;
};

}  // namespace

PECTORA_EFFECT(Attachment, {.id = "effect.attachment", .version = "1.0",
                            .summary = "The pleura hangs on the three nearest of ribs, cartilages and sternum",
                            .references = "Moreira et al., SPIE 2012; k = E A / L"})
