#include "plugins/model/hard_case/wall.h"

#include <cmath>
#include <limits>
#include <random>

namespace pectora {

std::shared_ptr<HardCase> makeRandomCase(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  const auto power = [&](double low, double high) { return std::pow(10, between(low, high)); };
  const auto count = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };

  // Geometry, stiffness and masses, with noise on every place.
  const double spacing = between(3, 15);
  const int rows = count(2, 11), columns = count(2, 11);
  HardWall wall(rows, columns, spacing, between(1, 5) * spacing, between(-20, 80));
  const double modulus = power(-1, 2);
  wall.callSprings(std::min(modulus * power(-3, 9), 1e9), modulus, power(0, 4));
  auto hard = std::make_shared<HardCase>();
  if (count(0, 3) == 0) {
    hard->isSpringsAlone = false;
    wall.callEffect("effect.volume", {{"poissons_ratio", between(0.3, 0.4999)}});
  }
  Scene& scene = *wall.scene;
  for (auto* layer : {&scene.outer, &scene.inner})
    for (Vec3& p : *layer) p += Vec3{between(-0.2, 0.2), between(-0.2, 0.2), between(-0.2, 0.2)} * spacing;
  for (auto* masses : {&scene.outerMass, &scene.innerMass})
    for (double& m : *masses) m *= power(-2, 2);

  // Half of them start elsewhere.
  if (count(0, 1) == 1) {
    const double far = power(-2, 1) * spacing;
    Motion& start = wall.startAtRest();
    for (auto* layer : {&start.outer, &start.inner})
      for (Vec3& p : *layer) p += Vec3{between(-far, far), between(-far, far), between(-far, far)};
  }

  // One in five is damaged: in four ways so that it must be refused, in one so that it must not pass as sound in silence.
  hard->must = Must::tell;
  if (count(0, 4) == 0) {
    const std::size_t point = std::size_t(count(0, scene.points() - 1));
    const int damage = count(0, 4);
    if (damage == 0) scene.outer[point].z = std::numeric_limits<double>::quiet_NaN();
    if (damage == 1) scene.innerMass[point] = 0;
    if (damage == 2) wall.callEffect("effect.stretch", {{"stiffness", -1.0}});
    if (damage == 3) scene.anchors.clear();
    if (damage == 4) scene.outer[point] = scene.outer[(point + 1) % scene.points()];
    if (damage < 4) hard->must = Must::refuse;
    // Volume has no meaning where a cell has none.
    if (damage == 4 && !hard->isSpringsAlone) hard->must = Must::flag;
  }
  // Half of those from rest are carried by their bones, too, beside the struts. (A start would have to say where the carriers are.)
  if (!wall.start && count(0, 1) == 1) wall.callEffect("effect.attachment", {{"youngs_modulus", modulus}});
  hard->name = "random";
  hard->text = "a scene drawn from the seed " + std::to_string(seed);
  hard->extent = wall.extent();
  hard->scene = wall.scene;
  hard->plan = wall.plan;
  hard->start = wall.start;
  return hard;
}

}  // namespace pectora
