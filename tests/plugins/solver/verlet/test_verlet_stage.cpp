// The solver as scripts see it, on a flat wall whose anchors are pushed forwards.
#include "tests/plugins/solver/wall.h"

#include "kernel/physics/workers.h"

using namespace pectora;

TEST(VerletSolver, ConvergesAndLiftsTheSkinWithTheBar) {
  const Wall wall(15);
  const auto motion = Solve("solver.verlet")(wall, {});
  EXPECT_EQ(motion->status, SolveStatus::converged);
  EXPECT_EQ(motion->invertedPrisms, 0);
  const int middle = 8 * 17 + 8;
  const double lifted = -20 - motion->outer[middle].y;
  EXPECT_GT(lifted, 9);    // the skin follows
  EXPECT_LT(lifted, 15.5); // and not beyond the bar
  EXPECT_LT(distance(motion->outer[0], wall.scene->outer[0]), 1.5);
}

TEST(VerletSolver, StaysAtRestWhenNothingIsLifted) {
  const Wall wall(0);
  const auto motion = Solve("solver.verlet")(wall, {});
  EXPECT_EQ(motion->status, SolveStatus::converged);
  EXPECT_LT(largestDifference(motion->outer, wall.scene->outer), 1e-12);
}

TEST(VerletSolver, ReachesTheSameEndWithEitherMass) {
  const Wall wall(10);
  Solve solve("solver.verlet");
  const auto scaled = solve(wall, {{"tolerance", 1e-7}});
  const auto tissue = solve(wall, {{"tolerance", 1e-7}, {"mass", std::string("tissue")}, {"max_iterations", 200000.0}});
  EXPECT_LT(largestDifference(scaled->outer, tissue->outer), 1e-3);
}

TEST(VerletSolver, AbsoluteStiffnessCancels) {
  // The task is driven by displacements: scaling every modulus leaves the shape.
  const Wall soft(10, 1), stiff(10, 1000);
  Solve solve("solver.verlet");
  EXPECT_LT(largestDifference(solve(soft, {{"tolerance", 1e-8}})->outer, solve(stiff, {{"tolerance", 1e-8}})->outer), 1e-4);
}

TEST(VerletSolver, KeepsTheMirrorSymmetryOfItsScene) {
  const Wall wall(10);
  // The anchors at +x are mirrored too, for this test.
  auto& anchors = wall.scene->anchors;
  const std::size_t count = anchors.size();
  for (std::size_t i = 0; i < count; ++i)
    if (Anchor a = anchors[i]; a.rest.x > wall.scene->inner[a.point].x + 1) a.rest.x -= 14, anchors.push_back(a);
  const auto motion = Solve("solver.verlet")(wall, {{"tolerance", 1e-8}});
  for (int r = 0; r < 17; ++r)
    for (int c = 0; c < 17; ++c) {
      const Vec3 p = motion->outer[r * 17 + c], q = motion->outer[r * 17 + 16 - c];
      EXPECT_LT(distance(p, {128 - q.x, q.y, q.z}), 1e-4);
    }
}

TEST(VerletSolver, RefusesAStepBeyondItsLimitAndTellsTheLimit) {
  const Wall wall(10);
  Solve solve("solver.verlet");
  const Error error = errorOf([&] { solve(wall, {{"time_step", 1.0}}); });
  EXPECT_TRUE(contains(error.what(), "stability limit")) << error.what();
  EXPECT_TRUE(contains(error.what(), "up to")) << error.what();
  EXPECT_EQ(error.kind(), ErrorKind::badInput);
}

TEST(VerletSolver, DoesNotPassOnWhatDidNotConverge) {
  const Wall wall(10);
  Solve solve("solver.verlet");
  const Error error = errorOf([&] { solve(wall, {{"max_iterations", 120.0}}); });
  EXPECT_EQ(error.kind(), ErrorKind::runFailed);
  const auto motion = solve(wall, {{"max_iterations", 120.0}, {"accept_unconverged", true}});
  EXPECT_EQ(motion->status, SolveStatus::stalled);
  EXPECT_FALSE(motion->message.empty());
  for (const Vec3& p : motion->outer) EXPECT_TRUE(isFinite(p));
}

TEST(VerletSolver, GivesTheSameBitsForAnyNumberOfThreads) {
  const Wall wall(10);
  const int before = threads();
  std::vector<Vec3> first;
  for (int count : {1, 2, 8}) {
    setThreads(count);
    const auto motion = Solve("solver.verlet")(wall, {});
    if (first.empty()) first = motion->outer;
    EXPECT_EQ(motion->outer, first) << count;
  }
  setThreads(before);
}

TEST(VerletSolver, StartsWhereAnEarlierMotionEnded) {
  const Wall wall(10);
  Solve solve("solver.verlet");
  const auto cold = solve(wall, {{"tolerance", 1e-6}});
  const auto warm = solve(wall, {{"tolerance", 1e-6}, {"ramp", 0.0}}, cold);
  EXPECT_LT(warm->iterations, cold->iterations);
  EXPECT_LT(largestDifference(warm->outer, cold->outer), 1e-2);
}

TEST(VerletSolver, StopsWhenCancelled) {
  const Wall wall(10);
  Solve solve("solver.verlet");
  solve.cancel = true;
  EXPECT_THROW(solve(wall, {}), Cancelled);
}
