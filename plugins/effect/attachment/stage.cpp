// Each pleura point hangs on the ribs, cartilages and sternum next to it; the skin's edge on the skin beyond.
#include "plugins/effect/attachment/carried.h"

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
           "Young's modulus of the intercostal tissue: a block of it from point to bone has the section of one cell");
    v.real("stiffness", stiffness_, "N/mm", {0, 1e12}, {0, 10}, "Spring constant given by hand; 0: from Young's modulus");
    v.choice("hold", hold_, {"carried", "struts"}, "carried: the tissue draws a point to where its bones carry it, in all directions alike; struts: the paper's springs, which turn freely about bone and point");
  }

  Contribution contribute(const Scene& scene, const System& system) override {
    Contribution part;
    if (scene.anchors.empty()) {
      part.emptyBecause = "no rib, cartilage or sternum was found to hold the pleura";
      return part;
    }
    // A block of length L and section A has k = E A / L; one shorter than 1 mm counts as 1 mm. The abdomen behind its
    // wall, and the skin beyond the model's edge, give way like a block as long as the wall is thick.
    const double area = scene.rowSpacing * scene.columnSpacing;
    double least = INFINITY, greatest = 0;
    Carried carried;
    for (std::size_t j = 0; j < scene.anchors.size(); ++j) {
      const Anchor& anchor = scene.anchors[j];
      const double length = anchor.body == BodyKind::still ? scene.thickness : std::max(1.0, distance(anchor.rest, scene.inner[anchor.point]));
      const double k = stiffness_ > 0 ? stiffness_ : youngsModulus_ * 1e-3 * area / length;
      const std::size_t node = system.node(anchor.isOnSkin ? 0 : system.layers - 1, anchor.point);
      if (hold_ == "carried") carried.add(node, system.rest[node], j, anchor.rest, k);
      else part.springs.push_back({node, system.anchorNode(j), k});
      least = std::min(least, k);
      greatest = std::max(greatest, k);
    }
    // A spring without length at rest pulls alike in all directions.
    for (const Carried::Point& point : carried.points()) {
      part.springs.push_back({point.node, system.rest.size() + part.guides.size(), point.stiffness});
      part.guides.push_back(point.place);
    }
    part.steering.guides = [carried](const Plan&, double, const std::vector<Vec3>& anchors) { return carried.places(anchors); };
    part.notes = {fmt::format("k = {:.4g} to {:.4g} N/mm", least, greatest)};
    return part;
  }

 private:
  double youngsModulus_ = 60;
  double stiffness_ = 0;
  std::string hold_ = "carried";
};

}  // namespace

PECTORA_EFFECT(Attachment, {.id = "effect.attachment", .version = "1.0",
                            .summary = "The pleura hangs on the three nearest of ribs, cartilages and sternum",
                            .references = "k = E A / L, carried: E = 1/2 sum k |x - x0 - u|^2 with the bones' displacements u; struts: Moreira et al., SPIE 2012"})
