#include "kernel/host/compile.h"

#include "kernel/host/settings.h"
#include "kernel/stage/effect.h"

#include <fmt/format.h>

#include <cmath>

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

}  // namespace

Compiled compile(const Scene& scene, Registry& registry) {
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
    compiled.effects.push_back(std::move(use));
  }
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
  return compiled;
}

Drive makeDrive(const Scene& scene, const Plan& plan) {
  Drive drive;
  const std::size_t frames = std::max<std::size_t>(2, plan.frames.size());
  for (std::size_t f = 0; f < frames; ++f) {
    std::vector<Vec3> positions;
    positions.reserve(scene.anchors.size());
    for (const Anchor& anchor : scene.anchors) positions.push_back(plan.moved(anchor, double(f) / double(frames - 1)));
    drive.frames.push_back(std::move(positions));
  }
  return drive;
}

}  // namespace pectora
