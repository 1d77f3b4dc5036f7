#include "app/view/session/effect_worth.h"

#include "app/view/session/live.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace pectora::view {
namespace {

// Of one evaluation of all forces, ms: the best of five.
double cost(const System& system) {
  NodeVectors gradient(system.rest.size());
  double best = INFINITY, largest = 0;
  for (int i = 0; i < 5; ++i) {
    const auto start = std::chrono::steady_clock::now();
    system.evaluate(system.rest, gradient, largest);
    best = std::min(best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

}  // namespace

std::vector<EffectWorth> measureEffects(const Choices& choices, const Scene& given, const Plan& plan, const Motion& with, const Compiled& whole,
                                        Registry& registry, Host& host, const std::function<void(double, const std::string&)>& progress) {
  std::vector<EffectWorth> worths;
  const double costOfAll = cost(*whole.system);
  for (std::size_t i = 0; i < choices.effects.size(); ++i) {
    if (!choices.effects[i].isOn) continue;
    EffectWorth worth;
    worth.id = choices.effects[i].plugin.id;
    progress(double(i) / double(choices.effects.size()), "without " + worth.id);
    auto scene = std::make_shared<Scene>(given);
    std::erase_if(scene->effects, [&](const auto& call) { return call->id == worth.id; });
    try {
      WarmSolve without(scene, choices.solver.id, makeSolver(registry, choices.solver), registry, host);
      const System& system = *without.compiled().system;
      worth.milliseconds = std::max(0.0, costOfAll - cost(system));
      // A guide less, such as of a bar that gives way, and the motion is another scene's: then from rest.
      if (with.anchors.size() == system.rest.size() - system.freeNodes) without.startFrom(with);
      const auto motion = without.solve(plan, host);
      double sum = 0;
      for (std::size_t p = 0; p < with.outer.size(); ++p) {
        const double d = distance(with.outer[p], motion->outer[p]);
        worth.largest = std::max(worth.largest, d);
        sum += d * d;
      }
      worth.rms = std::sqrt(sum / double(with.outer.size()));
    } catch (const Error&) {
      worth.isNeeded = true;
    }
    worths.push_back(worth);
  }
  return worths;
}

}  // namespace pectora::view
