#include "plugins/model/two_layer/masses.h"

namespace pectora {

void weighLayers(double density, Scene& scene) {
  // Density * cell * thickness / 2, mm^3 to m^3.
  for (int i = 0; i < scene.points(); ++i) {
    const double volume = scene.rowSpacing * scene.columnSpacing * distance(scene.outer[i], scene.inner[i]);
    scene.outerMass.push_back(0.5e-9 * density * volume);
    scene.innerMass.push_back(0.5e-9 * density * volume);
  }
}

}  // namespace pectora
