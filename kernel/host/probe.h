// What each effect changes in a scene, by rough solves with and without it, and which of them a wanted accuracy calls for.
#pragma once

#include "kernel/host/compile.h"
#include "kernel/stage/host.h"

namespace pectora {

/// Effects of a scene with what each changes (EffectUse::changeRms and the rest).
struct Probe {
  std::vector<EffectUse> effects;   ///< in the scene's order
  double uncertainty = NAN;         ///< of these figures, mm: how far another solver's answer to the whole scene lies from it (RMS); NAN if it has none
};
/// Distances are over the skin points that the whole scene moves by more than 3 mm, or all if there are none.
Probe probeEffects(const Scene& scene, const Plan& plan, Registry& registry, Host& host);

/// A scene that runs only the effects that the wanted accuracy calls for.
struct Choice {
  std::shared_ptr<const Scene> scene;
  Probe probe;                      ///< of all candidates; those left out are not active, and the reason says why
  double change = 0;                ///< what leaving all of those out changes together, RMS in mm
};
/// Leaves out those effects that change the skin by less than scene.effectAccuracy (RMS); if all of them together change more than
/// that, the greatest come back. Throws Error if the scene with all effects does not come to rest.
Choice chooseEffects(const Scene& scene, const Plan& plan, Registry& registry, Host& host);

}  // namespace pectora
