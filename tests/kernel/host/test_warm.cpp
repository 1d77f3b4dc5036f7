#include "kernel/host/warm.h"

#include "tests/kernel/host/quiet_host.h"
#include "tests/plugins/solver/wall.h"

using namespace pectora;

namespace {

struct Warm {
  Registry registry{{PECTORA_PLUGINS}};
  QuietHost host;
  WarmSolve make(std::shared_ptr<const Scene> scene, const std::string& id = "solver.newton") {
    auto solver = registry.open(id).descriptor->makeSolver();
    applySettings({{"tolerance", 1e-8}}, [&](Visitor& v) { solver->describe(v); });
    return {std::move(scene), id, std::move(solver), registry, host};
  }
};

}  // namespace

TEST(WarmSolve, EndsWhereASolveFromRestDoes) {
  Warm w;
  WarmSolve warm = w.make(Wall(10).scene);
  const auto rest = w.make(Wall(12).scene).solve(*Wall(12).plan, w.host);
  warm.solve(*Wall(10).plan, w.host);
  const auto moved = warm.solve(*Wall(12).plan, w.host);
  EXPECT_EQ(moved->status, SolveStatus::converged);
  // Both stop at a residual of 1e-8 of the largest spring force; the softest mode of this wall is some 1e3 softer than a spring.
  EXPECT_LT(largestDifference(moved->outer, rest->outer), 1e-4);
}

TEST(WarmSolve, NeedsFewerForcesThanFromRest) {
  Warm w;
  WarmSolve warm = w.make(Wall(10).scene);
  const int cold = warm.solve(*Wall(10).plan, w.host)->forceEvaluations;
  EXPECT_LT(warm.solve(*Wall(10.1).plan, w.host)->forceEvaluations, cold);
}

TEST(WarmSolve, GoesOnFromTheMotionOfASceneWithOtherEffects) {
  Warm w;
  const auto before = w.make(Wall(10).scene).solve(*Wall(10).plan, w.host);
  const Wall stiffer(10, 2);   // all moduli scaled alike: the same shape
  WarmSolve warm = w.make(stiffer.scene);
  warm.startFrom(*before);
  const auto after = warm.solve(*stiffer.plan, w.host);
  EXPECT_LT(largestDifference(before->outer, after->outer), 1e-4);
}

TEST(WarmSolve, TakesOverWhatSteersAndNothingThatDecides) {
  Warm w;
  const Wall soft(10), other(12, 1.2);
  WarmSolve before = w.make(soft.scene, "solver.multigrid"), fresh = w.make(other.scene, "solver.multigrid"), next = w.make(other.scene, "solver.multigrid");
  const auto motion = before.solve(*soft.plan, w.host);
  fresh.startFrom(*motion);
  next.startFrom(*motion);
  next.takeOver(before, w.host);
  const auto expected = fresh.solve(*other.plan, w.host), found = next.solve(*other.plan, w.host);
  EXPECT_EQ(found->status, SolveStatus::converged);
  EXPECT_LT(largestDifference(found->outer, expected->outer), 1e-4);
  EXPECT_NE(found->energyHistory, expected->energyHistory) << "it was steered by other coarse grids";
  // Another solver has nothing to give.
  WarmSolve newton = w.make(soft.scene), last = w.make(other.scene, "solver.multigrid");
  newton.solve(*soft.plan, w.host);
  last.takeOver(newton, w.host);
  EXPECT_LT(largestDifference(last.solve(*other.plan, w.host)->outer, expected->outer), 1e-4);
}

TEST(WarmSolve, RefusesTheMotionOfAnotherScene) {
  Warm w;
  WarmSolve warm = w.make(Wall(10).scene);
  EXPECT_THROW(warm.startFrom(Motion{}), Error);
}

TEST(WarmSolve, KeepsItsPlaceWhenCancelled) {
  Warm w;
  WarmSolve warm = w.make(Wall(10).scene);
  const auto first = warm.solve(*Wall(10).plan, w.host);
  w.host.isCancelled = true;
  EXPECT_THROW(warm.solve(*Wall(30).plan, w.host), Cancelled);
  w.host.isCancelled = false;
  EXPECT_LT(largestDifference(warm.solve(*Wall(10).plan, w.host)->outer, first->outer), 1e-4);
}

TEST(WarmSolve, EverySolverShowsItsWay) {
  for (const char* id : {"solver.newton", "solver.lbfgs", "solver.projective", "solver.implicit", "solver.semi_implicit", "solver.verlet"}) {
    Warm w;
    const Wall wall(10);
    auto solver = w.registry.open(id).descriptor->makeSolver();
    WarmSolve warm(wall.scene, id, std::move(solver), w.registry, w.host);
    warm.solve(*wall.plan, w.host);
    EXPECT_GT(w.host.previews, 1) << id;
    EXPECT_EQ(w.host.nodes, warm.compiled().system->rest.size()) << id;
  }
}
