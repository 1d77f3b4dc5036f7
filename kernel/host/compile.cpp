#include "kernel/host/compile.h"

#include "kernel/host/settings.h"
#include "kernel/physics/workers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pectora {
namespace {

std::size_t pairCount(const StencilSpring& s, const Scene& scene) {
  return std::size_t(std::max(0, scene.rows - std::abs(s.rows))) * std::max(0, scene.columns - std::abs(s.columns));
}

// A zero, negative or endless constant would make nonsense of the whole solution.
void checkStiffness(double stiffness, const std::string& effect) {
  if (std::isfinite(stiffness) && stiffness > 0) return;
  throw Error("a spring constant must be positive and finite")
      .inStage(effect).given(fmt::format("{:g} N/mm", stiffness)).advise("Check its stiffness and Young's modulus");
}

void checkNodes(const System& system) {
  for (std::size_t i = 0; i < system.rest.size(); ++i)
    if (!isFinite(system.rest[i]))
      throw Error("a position of the scene is not a finite number").at(system.nodeName(i));
  for (std::size_t i = 0; i < system.freeNodes; ++i)
    if (!(std::isfinite(system.mass[i]) && system.mass[i] > 0))
      throw Error("a mass must be positive and finite")
          .given(fmt::format("{:g} kg", system.mass[i])).at(system.nodeName(i)).advise("Check the tissue's density");
}

// Points that hang together, but on no anchor, have no place to be. A term that is more than springs joins all that it touches.
void checkIslands(const System& system) {
  std::vector<std::size_t> root(system.rest.size());
  std::iota(root.begin(), root.end(), std::size_t(0));
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  // All anchors count as one node, the last.
  const auto join = [&](std::size_t a, std::size_t b) {
    const std::size_t one = find(a < system.freeNodes ? a : root.size() - 1), other = find(b < system.freeNodes ? b : root.size() - 1);
    root[std::min(one, other)] = std::max(one, other);
  };
  for (const auto& term : system.terms) {
    if (!term->holds()) continue;
    if (term->hasSprings()) {
      term->forEachSpring([&](const Spring& s) { join(s.a, s.b); });
      continue;
    }
    std::vector<double> bound(system.rest.size());
    term->addStiffnessBound(bound);
    std::size_t last = root.size();
    for (std::size_t i = 0; i < bound.size(); ++i) {
      if (bound[i] <= 0) continue;
      if (last < root.size()) join(last, i);
      last = i;
    }
  }
  std::size_t loose = 0, first = 0;
  const std::size_t held = system.rest.size() > system.freeNodes ? find(root.size() - 1) : root.size();
  for (std::size_t i = system.freeNodes; i-- > 0;)
    if (find(i) != held) ++loose, first = i;
  if (loose > 0)
    throw Error(fmt::format("{} of {} points hang together, but on nothing that holds them", loose, system.freeNodes))
        .at(system.nodeName(first) + " and others").advise("Call effect.attachment and effect.cross in the scene; of a solid wall tissue and attachment");
}

// The driven nodes after part t of the plan, of which the part `reached` is carried out.
std::vector<Vec3> drivenNodes(const Scene& scene, const Compiled& compiled, const Plan& plan, double reached, double t) {
  constexpr std::size_t kPiece = 1024;
  const std::size_t count = scene.anchors.size();
  std::vector<Vec3> positions(count);
  positions.reserve(compiled.system->rest.size() - compiled.system->freeNodes);
  forEachPiece(count, kPiece, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) positions[i] = plan.moved(scene.anchors[i], reached * t);
  });
  for (const auto& [steering, guides] : compiled.steering)
    if (steering.displacement)
      for (std::size_t i = 0; i < count; ++i) positions[i] += steering.displacement(plan, scene.anchors[i]) * t;
  const std::vector<Vec3> anchors = positions;
  for (const auto& [steering, guides] : compiled.steering)
    if (guides > 0)
      for (const Vec3& guide : steering.guides(plan, reached * t, anchors)) positions.push_back(guide);
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!isFinite(positions[i]))
      throw Error("the plan moves an anchor to a place that is not a finite number").of("plan").at(fmt::format("anchor {}", i));
  return positions;
}

}  // namespace

Compiled compile(const Scene& scene, Registry& registry, CtLoads loads) {
  Compiled compiled;
  compiled.system = std::make_unique<System>();
  System& system = *compiled.system;

  // Nodes: layer by layer, then the anchors.
  system.rows = scene.rows;
  system.columns = scene.columns;
  system.layers = scene.layers();
  system.freeNodes = system.anchorNode(0);
  system.rest = NodeVectors(system.anchorNode(scene.anchors.size()));
  for (int l = 0; l < system.layers; ++l) {
    for (std::size_t i = 0; i < system.points(); ++i) system.rest.set(system.node(l, i), scene.layer(l)[i]);
    system.mass.insert(system.mass.end(), scene.layerMass(l).begin(), scene.layerMass(l).end());
  }
  for (std::size_t j = 0; j < scene.anchors.size(); ++j) system.rest.set(system.anchorNode(j), scene.anchors[j].rest);
  checkNodes(system);

  // Each effect that was called contributes; springs of one sort are collected for one term.
  std::vector<StencilSpring> stencil;
  std::vector<NodeSpring> springs;
  std::string stencilNames, springNames;
  std::vector<std::unique_ptr<Term>> others;
  for (const auto& call : scene.effects) {
    const Plugin& plugin = registry.open(call->id);
    const auto effect = plugin.descriptor->makeEffect();
    applySettings(call->settings, [&](Visitor& v) { effect->describe(v); });
    Contribution part;
    try {
      part = effect->contribute(scene, system);
    } catch (Error& error) {
      throw error.inStage(call->id);
    }
    EffectUse use;
    use.id = call->id;
    use.isActive = part.emptyBecause.empty();
    use.reason = part.emptyBecause;
    use.springs = part.springs.size();
    use.notes = part.notes;
    use.movesInTime = part.dynamics.isAskedFor();
    if (part.loadInCt) {
      compiled.isLoadedInCt = true;
      if (loads == CtLoads::alone) part.terms.clear();
      if (loads != CtLoads::off) part.terms.push_back(part.loadInCt(loads == CtLoads::alone ? 1 : -1));
    }
    for (const auto& term : part.terms) {
      use.hasHessian = use.hasHessian && term->hasHessian();
      use.hasSprings = use.hasSprings && term->hasSprings();
    }
    const std::string name = call->id.substr(call->id.find('.') + 1);
    for (const StencilSpring& s : part.stencil) checkStiffness(s.stiffnessNPerMm, call->id), use.springs += pairCount(s, scene);
    for (const NodeSpring& s : part.springs) checkStiffness(s.stiffnessNPerMm, call->id);
    if (!part.stencil.empty()) stencilNames += (stencilNames.empty() ? "" : ", ") + name;
    if (!part.springs.empty()) springNames += (springNames.empty() ? "" : ", ") + name;
    stencil.insert(stencil.end(), part.stencil.begin(), part.stencil.end());
    springs.insert(springs.end(), part.springs.begin(), part.springs.end());
    for (auto& term : part.terms) others.push_back(std::move(term));
    for (const Vec3& guide : part.guides) system.rest.append(guide);
    compiled.steering.push_back({std::move(part.steering), part.guides.size()});
    compiled.effects.push_back(std::move(use));
    Dynamics& dynamics = system.dynamics;
    dynamics = {std::max(dynamics.duration, part.dynamics.duration), std::max(dynamics.lifting, part.dynamics.lifting),
                std::max(dynamics.interval, part.dynamics.interval), dynamics.damping + part.dynamics.damping};
  }
  // A shape without load is one at rest.
  if (loads == CtLoads::alone) system.dynamics = {};
  if (!stencil.empty()) system.terms.push_back(makeLatticeTerm(stencilNames, system, std::move(stencil)));
  if (!springs.empty()) system.terms.push_back(makeSpringTerm(springNames, system, std::move(springs)));
  for (auto& term : others) system.terms.push_back(std::move(term));

  // A point that nothing holds has no place to be.
  const std::vector<double> bound = system.stiffnessBound();
  std::size_t loose = 0, first = 0;
  for (std::size_t i = bound.size(); i-- > 0;)
    if (bound[i] <= 0) ++loose, first = i;
  if (loose > 0)
    throw Error(fmt::format("{} of {} points are held by no spring", loose, bound.size()))
        .at(system.nodeName(first) + " and others").advise("Call the effects cross (or direct) and attachment in the scene; of a solid wall tissue and attachment");
  checkIslands(system);
  return compiled;
}

BarLoad shareLift(const Compiled& compiled, const Plan& plan) {
  double chest = 0, bar = INFINITY;
  for (const auto& [steering, guides] : compiled.steering) {
    if (steering.chestResistance) chest += steering.chestResistance(plan);
    if (steering.barResistance) bar = 1 / (1 / bar + 1 / steering.barResistance(plan));
  }
  BarLoad load;
  if (!(chest > 0)) return load;
  load.part = 1 / (1 + chest / bar);
  // The bars' forces F_j = f L_j do the work that the chest takes up: the sum of F_j L_j is that of the chest.
  double squares = 0;
  for (const Bar& lifted : plan.bars) squares += lifted.lift * lifted.lift;
  for (const Bar& lifted : plan.bars) load.forces.push_back(squares > 0 ? chest * load.part * lifted.lift / squares : 0);
  return load;
}

Drive makeDrive(const Scene& scene, const Compiled& compiled, const Plan& plan) {
  const double reached = shareLift(compiled, plan).part;
  Drive drive;
  const std::size_t frames = std::max<std::size_t>(2, plan.frames.size());
  for (std::size_t f = 0; f < frames; ++f) drive.frames.push_back(drivenNodes(scene, compiled, plan, reached, double(f) / double(frames - 1)));
  return drive;
}

Drive makeDriveEnd(const Scene& scene, const Compiled& compiled, const Plan& plan) {
  const System& system = *compiled.system;
  std::vector<Vec3> rest;
  for (std::size_t i = system.freeNodes; i < system.rest.size(); ++i) rest.push_back(system.rest[i]);
  return {{std::move(rest), drivenNodes(scene, compiled, plan, shareLift(compiled, plan).part, 1)}};
}

}  // namespace pectora
