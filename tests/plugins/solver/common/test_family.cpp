// All solvers on one wall: the same end, the same manners.
#include "tests/plugins/solver/wall.h"

#include "kernel/physics/workers.h"

#include <fstream>
#include <sstream>

using namespace pectora;

namespace {

class Family : public testing::TestWithParam<const char*> {};

std::string nameOf(const testing::TestParamInfo<const char*>& info) { return std::string(info.param).substr(7); }

const auto kMotion = testing::Values("solver.verlet", "solver.semi_implicit", "solver.implicit", "solver.newton", "solver.multigrid", "solver.lbfgs",
                                   "solver.projective");
INSTANTIATE_TEST_SUITE_P(Solver, Family, kMotion, nameOf);

// The same with solver.xpbd, which comes near the least energy only by its own order.
class AnySolver : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Solver, AnySolver, kMotion, nameOf);
INSTANTIATE_TEST_SUITE_P(Positions, AnySolver, testing::Values("solver.xpbd"), nameOf);

// A limit on iterations that no solver needs here, and a tolerance of 1e-8 (forces are about 1 N, stiffness 0.1 N/mm and
// more: 1e-7 mm a mode).
const Settings kTight{{"tolerance", 1e-8}, {"max_iterations", 100000.0}};

}  // namespace

TEST_P(Family, ReachesTheMinimumThatNewtonReaches) {
  for (const double lift : {10.0, 30.0}) {
    const Wall wall(lift);
    const auto reference = Solve("solver.newton")(wall, {{"tolerance", 1e-10}});
    const auto motion = Solve(GetParam())(wall, kTight);
    EXPECT_EQ(motion->status, SolveStatus::converged);
    EXPECT_LT(largestDifference(motion->outer, reference->outer), 1e-3) << lift;
    EXPECT_LT(largestDifference(motion->inner, reference->inner), 1e-3) << lift;
    EXPECT_NEAR(motion->energy, reference->energy, 1e-6 * reference->energy);
  }
}

TEST_P(Family, AccountsForItsWork) {
  const auto motion = Solve(GetParam())(Wall(10), {});
  EXPECT_EQ(motion->status, SolveStatus::converged);
  EXPECT_GT(motion->iterations, 0);
  EXPECT_GE(motion->forceEvaluations, motion->iterations);
  EXPECT_GT(motion->residual, 0);
  EXPECT_LE(motion->relativeResidual, 1e-4);
  EXPECT_GT(motion->energy, 0);
  EXPECT_GE(motion->energyHistory.size(), 3u);
}

TEST_P(AnySolver, StaysAtRestWhenNothingIsLifted) {
  const Wall wall(0);
  const auto motion = Solve(GetParam())(wall, {});
  EXPECT_EQ(motion->status, SolveStatus::converged);
  EXPECT_LT(largestDifference(motion->outer, wall.scene->outer), 1e-12);
}

TEST_P(Family, IsFasterFromWhereAnEarlierMotionEnded) {
  const Wall wall(10), next(12);
  Solve solve(GetParam());
  const auto from = solve(wall, {{"tolerance", 1e-6}}), cold = solve(next, {{"tolerance", 1e-6}}), warm = solve(next, {{"tolerance", 1e-6}}, from);
  EXPECT_LE(warm->forceEvaluations, cold->forceEvaluations);
  EXPECT_LT(largestDifference(warm->outer, cold->outer), 1e-2);
}

TEST_P(Family, ComesBackToRestWhenTheBarGoesBack) {
  const Wall up(10), back(0);
  Solve solve(GetParam());
  const auto motion = solve(back, {}, solve(up, {}));
  EXPECT_EQ(motion->status, SolveStatus::converged);
  EXPECT_LT(largestDifference(motion->outer, back.scene->outer), 1e-3);
}

TEST_P(AnySolver, GivesTheSameBitsForAnyNumberOfThreadsAndRunAfterRun) {
  // All effects at once that the solver takes.
  Wall wall(10);
  std::vector<const char*> effects{"effect.gravity"};
  if (std::string(GetParam()) != "solver.projective" && std::string(GetParam()) != "solver.xpbd")
    effects.insert(effects.end(), {"effect.volume", "effect.j_curve", "effect.rib_contact"});
  for (const char* effect : effects) wall.scene->effects.push_back(call(effect));
  const int before = threads();
  std::vector<Vec3> first;
  for (const int count : {1, 2, 8, 8}) {
    setThreads(count);
    const auto motion = Solve(GetParam())(wall, {{"accept_unconverged", true}, {"max_iterations", 300.0}});
    if (first.empty()) first = motion->outer;
    EXPECT_EQ(motion->outer, first) << count;
  }
  setThreads(before);
}

TEST_P(AnySolver, ConvergesOrSaysSoWhenLiftedBy80Mm) {
  const auto motion = Solve(GetParam())(Wall(80), {{"accept_unconverged", true}});
  for (const Vec3& p : motion->outer) ASSERT_TRUE(isFinite(p));
  for (const Vec3& p : motion->inner) ASSERT_TRUE(isFinite(p));
  EXPECT_NE(motion->status, SolveStatus::diverged) << motion->message;
  if (motion->status == SolveStatus::converged) EXPECT_LE(motion->relativeResidual, 1e-3);
  else EXPECT_FALSE(motion->message.empty());
}

TEST_P(AnySolver, DoesNotPassOnWhatDidNotConverge) {
  const Wall wall(30);
  Solve solve(GetParam());
  const Error error = errorOf([&] { solve(wall, {{"max_iterations", 2.0}}); });
  EXPECT_EQ(error.kind(), ErrorKind::runFailed);
  const auto motion = solve(wall, {{"max_iterations", 2.0}, {"accept_unconverged", true}});
  EXPECT_EQ(motion->status, SolveStatus::stalled);
  EXPECT_FALSE(motion->message.empty());
  for (const Vec3& p : motion->outer) EXPECT_TRUE(isFinite(p));
}

TEST_P(AnySolver, StopsWhenCancelled) {
  Solve solve(GetParam());
  solve.cancel = true;
  EXPECT_THROW(solve(Wall(10), {}), Cancelled);
}

TEST(NewtonSolver, ConvergesWhenLiftedBy80Mm) {
  const auto motion = Solve("solver.newton")(Wall(80), {});
  EXPECT_EQ(motion->status, SolveStatus::converged);
}

TEST(Pairing, ThatCannotWorkIsRefusedByNameBeforeAnyWork) {
  Wall wall(10);
  wall.scene->effects.push_back(call("effect.pull"));
  for (const char* id : {"solver.newton", "solver.implicit", "solver.projective"}) {
    Solve solve(id);
    const Error error = errorOf([&] { solve(wall, {}); });
    EXPECT_TRUE(contains(error.what(), id)) << error.what();
    EXPECT_TRUE(contains(error.what(), "effect.pull")) << error.what();
    EXPECT_EQ(error.kind(), ErrorKind::badInput);
  }
}

TEST(Pairing, WithAnEffectThatHasGradientsAloneWorksWhereThatIsEnough) {
  Wall wall(10), plain(10);
  wall.scene->effects.push_back(call("effect.pull"));
  const auto verlet = Solve("solver.verlet")(wall, kTight), lbfgs = Solve("solver.lbfgs")(wall, kTight);
  EXPECT_LT(largestDifference(verlet->outer, lbfgs->outer), 1e-3);
  EXPECT_GT(largestDifference(verlet->outer, Solve("solver.verlet")(plain, kTight)->outer), 0.1);
}

TEST(Scene, MapsNoPluginThatItDoesNotCall) {
  Solve("solver.newton")(Wall(5), {});
  std::ostringstream text;
  text << std::ifstream("/proc/self/maps").rdbuf();
  for (const char* called : {"solver.newton.so", "effect.cross.so", "effect.attachment.so"})
    EXPECT_NE(text.str().find(called), std::string::npos) << called;
  for (const char* other : {"effect.tissue.so", "effect.volume.so", "effect.gravity.so", "loader.dicom.so", "segmenter.thorax.so", "report.plot.so"})
    EXPECT_EQ(text.str().find(other), std::string::npos) << other;
}
