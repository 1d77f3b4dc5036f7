#include "kernel/host/probe.h"

#include "kernel/host/settings.h"
#include "kernel/host/warm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

// One solver probes; a second, which takes every effect, comes another way and shows how far two answers may lie apart.
struct Rough {
  const char* solver;
  double tolerance;
  int iterations;
};
constexpr Rough kFast{"solver.newton", 1e-4, 500}, kOther{"solver.verlet", 1e-4, 20000};
constexpr double kMoved = 3;   // mm

class Prober {
 public:
  Prober(const Scene& scene, const Plan& plan, Registry& registry, Host& host)
      : scene_(scene), plan_(plan), registry_(registry), host_(host), uses_(compile(scene, registry).effects) {}

  /// What becomes of the scene's effects, in its order.
  const std::vector<EffectUse>& uses() const { return uses_; }

  using Calls = std::vector<std::shared_ptr<const EffectCall>>;
  /// The skin at rest with these effects of the scene. Throws Error if it does not come to rest.
  std::vector<Vec3> skin(const Calls& calls, const Rough& rough) const {
    auto part = std::make_shared<Scene>(scene_);
    part->effects = calls;
    for (std::size_t i = 0; i < uses_.size(); ++i)
      if (uses_[i].movesInTime) std::erase(part->effects, scene_.effects[i]);
    auto solver = registry_.open(rough.solver).descriptor->makeSolver();
    applySettings({{"tolerance", rough.tolerance}, {"max_iterations", double(rough.iterations)}}, [&](Visitor& v) { solver->describe(v); });
    const auto motion = WarmSolve(part, rough.solver, std::move(solver), registry_, host_).solve(plan_, host_);
    if (motion->status != SolveStatus::converged) throw Error("the wall does not come to rest", ErrorKind::runFailed);
    return motion->outer;
  }

  /// RMS and largest distance of two skins, where `whole` moved.
  std::pair<double, double> distances(const std::vector<Vec3>& whole, const std::vector<Vec3>& other) const {
    const auto over = [&](double moved) {
      double sum = 0, largest = 0;
      std::size_t count = 0;
      for (std::size_t i = 0; i < whole.size(); ++i) {
        if (distance(whole[i], scene_.outer[i]) < moved) continue;
        const double d = distance(whole[i], other[i]);
        sum += d * d;
        largest = std::max(largest, d);
        ++count;
      }
      return count > 0 ? std::pair{std::sqrt(sum / double(count)), largest} : std::pair{-1.0, 0.0};
    };
    const auto moved = over(kMoved);
    return moved.first >= 0 ? moved : over(0);
  }

 private:
  const Scene& scene_;
  const Plan& plan_;
  Registry& registry_;
  Host& host_;
  std::vector<EffectUse> uses_;
};

std::string firstLine(const Error& error) {
  const std::string text = error.what();
  return text.substr(0, text.find('\n'));
}

// The skin of the whole scene, and the solver that found it.
struct Whole {
  std::vector<Vec3> skin;
  Rough by;
};
Whole solveWhole(const Prober& prober, const Scene& scene, Registry& registry) {
  if (registry.has(kFast.solver)) try {
    return {prober.skin(scene.effects, kFast), kFast};
  } catch (const Error&) {   // an effect without a Hessian, or no rest: the other one may
  }
  return {prober.skin(scene.effects, kOther), kOther};
}

Probe probe(const Prober& prober, const Scene& scene, const Whole& whole) {
  Probe found{prober.uses()};
  if (whole.by.solver != kOther.solver) try {
    found.uncertainty = prober.distances(whole.skin, prober.skin(scene.effects, kOther)).first;
  } catch (const Error&) {
  }
  for (std::size_t i = 0; i < found.effects.size(); ++i) {
    EffectUse& use = found.effects[i];
    if (!use.isActive) continue;
    if (use.movesInTime) {
      use.notProbed = "it tells the way in time, and leaves the rest where it is";
      continue;
    }
    auto others = scene.effects;
    others.erase(others.begin() + std::ptrdiff_t(i));
    try {
      std::tie(use.changeRms, use.changeMax) = prober.distances(whole.skin, prober.skin(others, whole.by));
    } catch (const Error& error) {
      use.notProbed = "without it: " + firstLine(error);
    }
  }
  return found;
}

}  // namespace

Probe probeEffects(const Scene& scene, const Plan& plan, Registry& registry, Host& host) {
  const Prober prober(scene, plan, registry, host);
  try {
    return probe(prober, scene, solveWhole(prober, scene, registry));
  } catch (const Error& error) {
    Probe none{prober.uses()};
    for (EffectUse& use : none.effects) use.notProbed = firstLine(error);
    return none;
  }
}

Choice chooseEffects(const Scene& given, const Plan& plan, Registry& registry, Host& host) {
  const double wanted = given.effectAccuracy;
  // An effect that cannot be built here is no candidate.
  Scene scene = given;
  std::vector<EffectUse> impossible;
  while (true) {
    try {
      compile(scene, registry);
      break;
    } catch (const Error& error) {
      const auto guilty = std::find_if(scene.effects.begin(), scene.effects.end(), [&](const auto& call) { return call->id == error.stage(); });
      if (guilty == scene.effects.end()) throw;
      impossible.push_back({.id = error.stage(), .isActive = false, .reason = firstLine(error)});
      scene.effects.erase(guilty);
    }
  }

  const Prober prober(scene, plan, registry, host);
  const Whole whole = solveWhole(prober, scene, registry);
  Choice choice;
  choice.probe = probe(prober, scene, whole);
  std::vector<EffectUse>& effects = choice.probe.effects;
  // What changes too little goes; what cannot be left out stays.
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < effects.size(); ++i)
    if (effects[i].isActive && effects[i].notProbed.empty() && effects[i].changeRms < wanted) out.push_back(i);
  std::sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) { return effects[a].changeRms < effects[b].changeRms; });

  // Together they may change more than each alone: then the greatest comes back.
  auto part = std::make_shared<Scene>(scene);
  for (;; out.pop_back()) {
    part->effects.clear();
    for (std::size_t i = 0; i < effects.size(); ++i)
      if (effects[i].isActive && std::find(out.begin(), out.end(), i) == out.end()) part->effects.push_back(scene.effects[i]);
    if (out.empty()) break;
    try {
      choice.change = prober.distances(whole.skin, prober.skin(part->effects, whole.by)).first;
      if (choice.change < wanted) break;
    } catch (const Error&) {
    }
  }
  if (out.empty()) choice.change = 0;
  for (const std::size_t i : out) {
    effects[i].isActive = false;
    effects[i].reason = fmt::format("it changes less than the {:g} mm wanted", wanted);
    if (effects[i].changeRms + choice.probe.uncertainty >= wanted)
      effects[i].reason += fmt::format(", which is not sure: two solvers' answers lie {:.2f} mm apart", choice.probe.uncertainty);
  }
  part->effectAccuracy = 0;
  choice.scene = part;
  effects.insert(effects.end(), impossible.begin(), impossible.end());
  return choice;
}

}  // namespace pectora
