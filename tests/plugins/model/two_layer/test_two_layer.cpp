#include "tests/plugins/model/common/barrel.h"

#include "plugins/model/two_layer/masses.h"

#include <gtest/gtest.h>

using namespace pectora;

TEST(Layers, WeighWhatTheWallWeighs) {
  Scene scene = built(barrel(), 8);
  weighLayers(1060, scene);
  double total = 0;
  for (int i = 0; i < scene.points(); ++i) total += scene.outerMass[i] + scene.innerMass[i];
  // Each point stands for a cell of the skin's grid, so the outer area counts.
  double volume = 0;
  for (int i = 0; i < scene.points(); ++i) volume += scene.rowSpacing * scene.columnSpacing * distance(scene.outer[i], scene.inner[i]);
  EXPECT_NEAR(total, 1060e-9 * volume, 1e-9 * total);
}
