#include "plugins/model/hard_case/wall.h"

#include <algorithm>
#include <cmath>

namespace pectora {

HardWall::HardWall(int rows, int columns, double spacing, double thickness, double lift) {
  auto cage = std::make_shared<RibCage>();
  cage->anatomy = std::make_shared<Anatomy>();
  scene->cage = plan->cage = cage;
  scene->rows = rows;
  scene->columns = columns;
  scene->rowSpacing = scene->columnSpacing = spacing;
  scene->thickness = thickness;
  const double middleRow = 0.5 * (rows - 1), middleColumn = 0.5 * (columns - 1), radius = 0.22 * std::max(rows, columns);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      scene->outer.push_back({spacing * c, -thickness, spacing * r});
      scene->inner.push_back({spacing * c, 0, spacing * r});
      const bool moves = std::hypot(r - middleRow, c - middleColumn) <= radius;
      for (const Vec3 part : {Vec3{0, 0.8, 0}, Vec3{0.9, 0.4, 0}, Vec3{0, 0.4, 0.9}})
        scene->anchors.push_back({scene->index(r, c), moves ? BodyKind::sternum : BodyKind::rib, 0, 0, scene->inner.back() + part * spacing});
    }
  // Water's density, shared by both layers.
  scene->outerMass.assign(scene->points(), 0.5e-6 * spacing * spacing * thickness);
  scene->innerMass = scene->outerMass;
  plan->bars = {{.lift = lift}};
  plan->motion.translation = {0, -lift, 0};
  plan->frames.assign(2, {});
}

void HardWall::callEffect(const std::string& id, Settings settings) {
  auto call = std::make_shared<EffectCall>();
  call->id = id;
  call->settings = std::move(settings);
  scene->effects.push_back(std::move(call));
}

void HardWall::callSprings(double skin, double wall, double attachment) {
  for (const char* id : {"effect.stretch", "effect.shear", "effect.bend"}) callEffect(id, {{"youngs_modulus", skin}});
  for (const char* id : {"effect.direct", "effect.cross"}) callEffect(id, {{"youngs_modulus", wall}});
  // The paper's struts can be pushed through themselves.
  callEffect("effect.attachment", {{"youngs_modulus", attachment}, {"hold", std::string("struts")}});
}

Motion& HardWall::startAtRest() {
  start = std::make_shared<Motion>();
  start->scene = scene;
  start->outer = scene->outer;
  start->inner = scene->inner;
  for (const Anchor& anchor : scene->anchors) start->anchors.push_back(anchor.rest);
  return *start;
}

double HardWall::extent() const {
  return std::max({scene->rows * scene->rowSpacing, scene->columns * scene->columnSpacing, scene->thickness});
}

}  // namespace pectora
