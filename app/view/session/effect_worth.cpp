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

// The scene with one effect less or more, solved from where the whole one came to rest.
EffectWorth measure(EffectWorth worth, const std::shared_ptr<const Scene>& changed, const PluginChoice& solver, const Plan& plan, const Motion& with, double costOfAll,
                    Registry& registry, Host& host) {
  try {
    WarmSolve solve(changed, solver.id, makeSolver(registry, solver), registry, host);
    const System& system = *solve.compiled().system;
    for (const EffectUse& use : solve.compiled().effects)
      if (use.id == worth.id && !use.isActive) worth.idle = use.reason;
    if (!worth.idle.empty()) return worth;
    worth.milliseconds = std::max(0.0, (worth.isOn ? 1 : -1) * (costOfAll - cost(system)));
    // A guide more or less, such as of a bar that gives way, and the motion is another scene's: then from rest.
    if (with.anchors.size() == system.rest.size() - system.freeNodes) solve.startFrom(with);
    const auto motion = solve.solve(plan, host);
    double sum = 0;
    for (std::size_t p = 0; p < with.outer.size(); ++p) {
      const double d = distance(with.outer[p], motion->outer[p]);
      worth.largest = std::max(worth.largest, d);
      sum += d * d;
    }
    worth.rms = std::sqrt(sum / double(with.outer.size()));
  } catch (const Error& error) {
    worth.refused = error.what();
  }
  return worth;
}

}  // namespace

std::vector<EffectWorth> measureEffects(const Choices& choices, const Scene& given, const Plan& plan, const Motion& with, const Compiled& whole,
                                        Registry& registry, Host& host, const std::function<void(double, const std::string&)>& progress) {
  // Those of the scene first, then the others with the settings that were chosen for them, if any.
  std::vector<PluginChoice> effects;
  for (const EffectChoice& effect : choices.effects)
    if (effect.isOn) effects.push_back(effect.plugin);
  const std::size_t on = effects.size();
  for (const EffectChoice& effect : choices.effects)
    if (!effect.isOn) effects.push_back(effect.plugin);
  for (const std::string& id : registry.ids())
    if (id.starts_with("effect.") && std::none_of(effects.begin(), effects.end(), [&](const PluginChoice& e) { return e.id == id; })) effects.push_back({id});

  std::vector<EffectWorth> worths;
  const double costOfAll = cost(*whole.system);
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const EffectWorth worth{.id = effects[i].id, .isOn = i < on};
    progress(double(i) / double(effects.size()), (worth.isOn ? "without " : "with ") + worth.id);
    auto scene = std::make_shared<Scene>(given);
    if (worth.isOn) {
      std::erase_if(scene->effects, [&](const auto& call) { return call->id == worth.id; });
    } else {
      auto call = std::make_shared<EffectCall>();
      call->id = worth.id, call->settings = effects[i].settings;
      scene->effects.push_back(std::move(call));
    }
    worths.push_back(measure(worth, scene, choices.solver, plan, with, costOfAll, registry, host));
  }
  return worths;
}

}  // namespace pectora::view
