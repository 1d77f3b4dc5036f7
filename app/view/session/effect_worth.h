// What each effect of a scene changes and costs, and what others would.
#pragma once

#include "app/view/session/choices.h"

#include "kernel/host/warm.h"

#include <functional>

namespace pectora::view {

/// What leaving out one effect changes, or taking it in.
struct EffectWorth {
  std::string id;
  bool isOn = true;              ///< in the scene, and left out; or taken in
  std::string refused = {};      ///< why the scene cannot be solved so; empty: it can
  std::string idle = {};         ///< why it would have nothing to do in this scene; empty: it has
  double largest = 0, rms = 0;   ///< change of the skin, mm
  double milliseconds = 0;       ///< of one evaluation of all forces that it costs
};

/// Leaves out each effect that is on in turn, takes in each of the others that there are, and solves again from `with`, the motion of
/// `scene` for `plan` that `whole` has compiled. `progress` from 0 to 1. Throws Cancelled.
std::vector<EffectWorth> measureEffects(const Choices& choices, const Scene& scene, const Plan& plan, const Motion& with, const Compiled& whole,
                                        Registry& registry, Host& host, const std::function<void(double, const std::string&)>& progress);

}  // namespace pectora::view
