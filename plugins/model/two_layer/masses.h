// What the points of the two layers weigh.
#pragma once

#include "kernel/value/scene.h"

namespace pectora {

/// Fills outerMass and innerMass: each layer carries half of the wall of `density` kg/m^3, cell by cell of the mean spacings.
void weighLayers(double density, Scene& scene);

}  // namespace pectora
