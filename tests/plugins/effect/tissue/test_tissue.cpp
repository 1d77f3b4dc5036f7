// The effect as scenes call it, with the solvers.
#include "tests/plugins/solver/wall.h"

#include "kernel/host/compile.h"
#include "kernel/physics/workers.h"

using namespace pectora;

namespace {

// The wall that is pushed forwards, as a solid of three cells: fat over muscle.
Wall solid(double lift) {
  Wall w(lift);
  Scene& s = *w.scene;
  for (const double part : {1.0 / 3, 2.0 / 3}) {
    s.between.emplace_back();
    for (int i = 0; i < s.points(); ++i) s.between.back().push_back(lerp(s.outer[i], s.inner[i], part));
    s.betweenMass.push_back(s.outerMass);
  }
  s.tissues = {{"fat", 3, 0.45, 930}, {"muscle", 20, 0.45, 1060}};
  for (int i = 0; i < s.cells(); ++i) s.cellTissue.push_back(i < s.cells() / 3 ? 0 : 1);
  s.effects = {call("effect.tissue"), call("effect.attachment")};
  return w;
}

}  // namespace

TEST(TissueEffect, SaysWhatTheCellsAreAndHoldsEveryLayer) {
  Registry registry({PECTORA_PLUGINS});
  const Compiled compiled = compile(*solid(10).scene, registry);
  EXPECT_TRUE(contains(compiled.effects[0].notes[0], "256 cells of fat")) << compiled.effects[0].notes[0];
  EXPECT_TRUE(contains(compiled.effects[0].notes[1], "512 cells of muscle"));
  for (const double b : compiled.system->stiffnessBound()) EXPECT_GT(b, 0);
}

TEST(TissueEffect, DropsOutOfALatticeAndSaysWhy) {
  Registry registry({PECTORA_PLUGINS});
  Wall w(10);
  w.scene->effects.push_back(call("effect.tissue"));
  EXPECT_TRUE(contains(compile(*w.scene, registry).effects.back().reason, "model.volume_mesh"));
}

TEST(TissueEffect, LiftsTheSkinWithTheBarAlikeBySeveralSolvers) {
  const Wall w = solid(12);
  const auto reference = Solve("solver.newton")(w, {{"tolerance", 1e-8}});
  const double lifted = -20 - reference->outer[8 * 17 + 8].y;
  EXPECT_GT(lifted, 6);
  EXPECT_LT(lifted, 12.5);
  EXPECT_EQ(reference->invertedPrisms, 0);
  ASSERT_EQ(reference->between.size(), 2u);
  // A residual of 1e-6 of the largest force leaves about that part of the lift times the wall's softness.
  for (const char* solver : {"solver.lbfgs", "solver.implicit", "solver.verlet"}) {
    const auto motion = Solve(solver)(w, {{"tolerance", 1e-6}});
    EXPECT_LT(largestDifference(motion->outer, reference->outer), 5e-3) << solver;
    EXPECT_LT(largestDifference(motion->between[1], reference->between[1]), 5e-3) << solver;
  }
}

TEST(TissueEffect, IsRefusedBySolversOfSpringsByName) {
  const Wall w = solid(12);
  Solve solve("solver.projective");
  const std::string text = errorOf([&] { solve(w, {}); }).what();
  EXPECT_TRUE(contains(text, "effect.tissue")) << text;
}

TEST(TissueEffect, StartsWhereAnEarlierMotionEnded) {
  const Wall w = solid(12);
  Solve solve("solver.newton");
  const auto cold = solve(w, {{"tolerance", 1e-6}}), warm = solve(w, {{"tolerance", 1e-6}}, cold);
  EXPECT_LT(warm->iterations, cold->iterations);
  EXPECT_LT(largestDifference(warm->between[0], cold->between[0]), 1e-3);
  // A motion of a lattice does not fit.
  const Wall lattice(12);
  const std::string text = errorOf([&] { solve(w, {}, solve(lattice, {})); }).what();
  EXPECT_TRUE(contains(text, "4 layers")) << text;
}

TEST(TissueEffect, GivesTheSameBitsForAnyNumberOfThreads) {
  const Wall w = solid(10);
  const int before = threads();
  std::vector<Vec3> first;
  for (int count : {1, 2, 8}) {
    setThreads(count);
    const auto motion = Solve("solver.newton")(w, {});
    if (first.empty()) first = motion->outer;
    EXPECT_EQ(motion->outer, first) << count;
  }
  setThreads(before);
}
