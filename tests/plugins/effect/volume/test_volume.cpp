// The lattice with its volume kept, as scripts see it.
#include "tests/plugins/solver/wall.h"

#include "kernel/host/compile.h"

using namespace pectora;

namespace {

// The wall that is pushed forwards, with or without the volume effect and springs that leave room for it.
Wall wall(double lift, double poissonsRatio) {
  Wall w(lift);
  for (auto& effect : w.scene->effects)
    if (effect->id == "effect.direct" || effect->id == "effect.cross")
      effect = call(effect->id, {{"youngs_modulus", 10.0}, {"poissons_ratio", poissonsRatio}});
  if (poissonsRatio > 0.25) w.scene->effects.push_back(call("effect.volume", {{"youngs_modulus", 10.0}, {"poissons_ratio", poissonsRatio}}));
  return w;
}

// Largest relative change of volume of the grid's cells, each the mean of its two cuts into five tetrahedra: as its faces are
// bilinear, that is exact.
double volumeChange(const Scene& scene, const Motion& motion) {
  const auto volume = [&](const std::vector<Vec3>& outer, const std::vector<Vec3>& inner, int i) {
    const auto tetrahedron = [](Vec3 p, Vec3 q, Vec3 r, Vec3 s) { return std::abs(dot(cross(q - p, r - p), s - p)) / 6; };
    double sum = 0;
    for (const auto& [a, b, d, e] : {std::array{i, i + 1, i + scene.columns, i + scene.columns + 1}, std::array{i + 1, i, i + scene.columns + 1, i + scene.columns}})
      sum += tetrahedron(outer[a], outer[b], outer[d], inner[a]) + tetrahedron(outer[e], outer[d], outer[b], inner[e]) +
             tetrahedron(inner[b], inner[a], inner[e], outer[b]) + tetrahedron(inner[d], inner[e], inner[a], outer[d]) +
             tetrahedron(outer[b], outer[d], inner[a], inner[e]);
    return sum / 2;
  };
  double largest = 0;
  for (int r = 0; r + 1 < scene.rows; ++r)
    for (int c = 0; c + 1 < scene.columns; ++c) {
      const int i = scene.index(r, c);
      largest = std::max(largest, std::abs(volume(motion.outer, motion.inner, i) / volume(scene.outer, scene.inner, i) - 1));
    }
  return largest;
}

}  // namespace

TEST(VolumeEffect, KeepsTheCellsVolumeWhereSpringsDoNot) {
  Solve solve("solver.newton");
  const Wall springs = wall(15, 0.25), kept = wall(15, 0.45), hard = wall(15, 0.499);
  const double without = volumeChange(*springs.scene, *solve(springs, {})), with = volumeChange(*kept.scene, *solve(kept, {})),
               nearly = volumeChange(*hard.scene, *solve(hard, {}));
  EXPECT_GT(without, 0.05);
  EXPECT_LT(with, 0.5 * without);
  EXPECT_LT(nearly, 0.1 * without);
}

TEST(VolumeEffect, DropsOutAtThePoissonsRatioOfSprings) {
  Registry registry({PECTORA_PLUGINS});
  Wall w = wall(15, 0.25);
  w.scene->effects.push_back(call("effect.volume", {{"poissons_ratio", 0.25}}));
  EXPECT_FALSE(compile(*w.scene, registry).effects.back().isActive);
}

TEST(VolumeEffect, WithItsSpringsHasTheModuliOfTheTissue) {
  // Uniform strains of a flat wall far from its edges: energy of springs across the wall and volume together, per volume, is
  // mu e:e + lambda/2 tr(e)^2. The springs are homogenised over a spacing of H / 2.45, where their weights are equal.
  const double nu = 0.45, e = 10, mu = e * 1e-3 / (2 * (1 + nu)), lambda = 2 * mu * nu / (1 - 2 * nu);
  Registry registry({PECTORA_PLUGINS});
  Scene scene;
  scene.cage = std::make_shared<RibCage>();
  scene.rows = scene.columns = 61;
  scene.thickness = 20;
  scene.rowSpacing = scene.columnSpacing = 20 / 2.45;
  for (int r = 0; r < 61; ++r)
    for (int c = 0; c < 61; ++c) {
      scene.outer.push_back({scene.columnSpacing * c, -20, scene.rowSpacing * r});
      scene.inner.push_back({scene.columnSpacing * c, 0, scene.rowSpacing * r});
    }
  scene.outerMass.assign(scene.points(), 1e-3);
  scene.innerMass = scene.outerMass;
  const Settings settings{{"youngs_modulus", e}, {"poissons_ratio", nu}};
  // A wall must hang on something: one pleura point on an anchor at its place, which these strains leave there.
  scene.anchors = {{0, BodyKind::rib, 0, 0, scene.inner[0]}};
  scene.effects = {call("effect.direct", settings), call("effect.cross", settings), call("effect.volume", settings), call("effect.attachment")};
  const Compiled compiled = compile(scene, registry);
  const System& system = *compiled.system;
  // Springs that would reach over the edge are missing: up to 2 rows of 61 at each side, 7 %.
  const double volume = 20 * 60 * 60 * scene.rowSpacing * scene.columnSpacing, strain = 1e-3;
  NodeVectors thicker = system.rest, sheared = system.rest;
  for (std::size_t i = 0; i < system.rest.size(); ++i) {
    thicker.y[i] *= 1 + strain;
    sheared.x[i] += 2 * strain * system.rest.y[i];
  }
  EXPECT_NEAR(system.energy(thicker) / (volume * strain * strain), mu + lambda / 2, 0.07 * (mu + lambda / 2));
  EXPECT_NEAR(system.energy(sheared) / (volume * strain * strain), 2 * mu, 0.07 * 2 * mu);
}
