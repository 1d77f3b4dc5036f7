#include "kernel/host/rest_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace pectora {
namespace {

constexpr double kNear = 0.02;   // mm: far below what a CT shows
constexpr int kMostSolves = 15;
constexpr double kLeastPart = 0.1, kMostPart = 1.5;   // of the way back that a point is taken at once

std::vector<Vec3>& layerOf(Scene& scene, int l) { return l == 0 ? scene.outer : l + 1 == scene.layers() ? scene.inner : scene.between[l - 1]; }

// One solve: where the load brings a guess of the shape, begun at the shape shown.
class Loaded {
 public:
  Loaded(const Scene& shown, const Scene& guess, Solver& solver, Registry& registry, Host& host) : shown_(shown) {
    const Compiled compiled = compile(guess, registry, CtLoads::alone);
    const System& system = *compiled.system;
    std::vector<Vec3> still;
    for (std::size_t i = system.freeNodes; i < system.rest.size(); ++i) still.push_back(system.rest[i]);
    NodeVectors start = system.rest;
    for (int l = 0; l < system.layers; ++l)
      for (std::size_t i = 0; i < system.points(); ++i) start.set(system.node(l, i), shown.layer(l)[i]);
    const Solution end = solver.prepare(system, host)->solve({{still, still}}, &start, host);
    for (int l = 0; l < system.layers; ++l) {
      away_.emplace_back();
      part_.emplace_back(system.points(), 1.0);
      for (std::size_t i = 0; i < system.points(); ++i) {
        away_.back().push_back(end.positions[system.node(l, i)] - shown.layer(l)[i]);
        worst_ = std::max(worst_, norm(away_.back().back()));
      }
    }
  }

  /// The farthest that a point comes from where it is shown, mm.
  double worst() const { return worst_; }
  /// Takes the guess back by part of that, with the anchors that a point sits on. The part is each point's own: what would
  /// have been right the time before (Aitken's relaxation), since a point on a soft wall goes farther than its guess.
  void correct(Scene& guess, const Loaded* before) {
    for (int l = 0; l < guess.layers(); ++l)
      for (std::size_t i = 0; i < away_[l].size(); ++i) {
        if (before) {
          const Vec3 change = away_[l][i] - before->away_[l][i];
          const double squared = dot(change, change);
          const double part = squared > 0 ? -before->part_[l][i] * dot(before->away_[l][i], change) / squared : 1;
          part_[l][i] = std::clamp(part, kLeastPart, kMostPart);
        }
        layerOf(guess, l)[i] += away_[l][i] * -part_[l][i];
      }
    for (std::size_t j = 0; j < guess.anchors.size(); ++j) {
      Anchor& anchor = guess.anchors[j];
      const int l = anchor.isOnSkin ? 0 : guess.layers() - 1;
      if (distance(shown_.anchors[j].rest, shown_.layer(l)[anchor.point]) < 1e-9) anchor.rest = guess.layer(l)[anchor.point];
    }
  }

 private:
  const Scene& shown_;
  std::vector<std::vector<Vec3>> away_;
  std::vector<std::vector<double>> part_;
  double worst_ = 0;
};

}  // namespace

std::shared_ptr<const Scene> findRestShape(const Scene& scene, Solver& solver, Registry& registry, Host& host) {
  auto found = std::make_shared<Scene>(scene);
  std::optional<Loaded> before;
  double first = 0;
  for (int n = 1; n <= kMostSolves; ++n) try {
    Loaded loaded(scene, *found, solver, registry, host);
    host.progress(0, fmt::format("shape without load, {:.2f} mm to go", loaded.worst()));
    if (loaded.worst() <= kNear) {
      host.info(fmt::format("the shape without load was found by {} solves, to {:.3f} mm", n, loaded.worst()));
      return found;
    }
    // By its fourth guess a wall that holds its weight has lost most of what was wrong with the first.
    first = n == 1 ? loaded.worst() : first;
    if (n >= 4 && loaded.worst() > 0.25 * first) return nullptr;
    loaded.correct(*found, before ? &*before : nullptr);
    before.emplace(std::move(loaded));
  } catch (const Error&) {
    if (n == 1) throw;
    return nullptr;   // a guess of which no wall can be made
  }
  return nullptr;
}

}  // namespace pectora
