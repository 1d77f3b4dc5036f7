// The solver: fast on fine walls, right on all.
#include "plugins/solver/multigrid/multigrid.h"

#include "plugins/solver/common/newton.h"
#include "tests/plugins/solver/multigrid/walls.h"
#include "tests/plugins/solver/wall.h"

#include <gtest/gtest.h>

using namespace pectora;

namespace {

double largestDistance(const NodeVectors& a, const NodeVectors& b, std::size_t count) {
  double largest = 0;
  for (std::size_t i = 0; i < count; ++i) largest = std::max(largest, distance(a[i], b[i]));
  return largest;
}

}  // namespace

TEST(Multigrid, FindsTheSameRestAsNewton) {
  const System system = fineWall(33);
  const Drive drive = bump(system, 15);
  QuietHost host;
  QuasiStaticSettings settings;
  settings.tolerance = 1e-9;
  const Solution expected = makeQuasiStatic(system, settings, std::make_unique<Newton>(system), 100)->solve(drive, nullptr, host);
  const Solution found = multigrid(system, 1e-8)->solve(drive, nullptr, host);
  ASSERT_EQ(expected.status, SolveStatus::converged);
  ASSERT_EQ(found.status, SolveStatus::converged);
  EXPECT_LT(largestDistance(found.positions, expected.positions, system.freeNodes), 1e-4);
}

TEST(Multigrid, NeedsNoMoreStepsOnAFinerGrid) {
  std::vector<int> evaluations;
  for (const int n : {24, 48, 96}) {
    const System system = fineWall(n);
    QuietHost host;
    const auto session = multigrid(system, 1e-3);
    const Solution before = session->solve(bump(system, 10), nullptr, host);
    ASSERT_EQ(before.status, SolveStatus::converged);
    const Solution after = session->solve(bump(system, 12), &before.positions, host);
    ASSERT_EQ(after.status, SolveStatus::converged);
    evaluations.push_back(after.forceEvaluations);
  }
  EXPECT_LE(evaluations.back(), 2 * evaluations.front()) << evaluations[0] << " " << evaluations[1] << " " << evaluations[2];
}

TEST(Multigrid, KeepsTheAccuracyThatItWasGiven) {
  const System system = fineWall(65);
  QuietHost host;
  const Solution start = multigrid(system, 1e-8)->solve(bump(system, 18), nullptr, host);
  const Solution exact = multigrid(system, 1e-8)->solve(bump(system, 20), &start.positions, host);
  ASSERT_EQ(exact.status, SolveStatus::converged);
  for (const double accuracy : {1.0, 0.1, 0.01}) {
    const Solution found = multigrid(system, 1e-12, accuracy)->solve(bump(system, 20), &start.positions, host);
    EXPECT_EQ(found.status, SolveStatus::converged);
    EXPECT_LT(found.forceEvaluations, exact.forceEvaluations);
    EXPECT_LT(largestDistance(found.positions, exact.positions, system.freeNodes), accuracy);
  }
}

TEST(Multigrid, SolvesAWallThroughTheProgram) {
  const Wall wall(20);
  const auto expected = Solve("solver.newton")(wall, {{"tolerance", 1e-10}});
  const auto found = Solve("solver.multigrid")(wall, {{"tolerance", 1e-8}});
  EXPECT_EQ(found->status, SolveStatus::converged);
  EXPECT_LT(largestDifference(found->outer, expected->outer), 1e-3);
}

TEST(Multigrid, TakesSpringsThatReachFartherThanThePapers) {
  const System system = fineWall(33, 5);
  QuietHost host;
  const Solution found = multigrid(system, 1e-8)->solve(bump(system, 10), nullptr, host);
  EXPECT_EQ(found.status, SolveStatus::converged);
  QuasiStaticSettings settings;
  settings.tolerance = 1e-9;
  const Solution exact = makeQuasiStatic(system, settings, std::make_unique<Newton>(system), 60)->solve(bump(system, 10), nullptr, host);
  EXPECT_LT(largestDistance(found.positions, exact.positions, system.freeNodes), 1e-3);
}

TEST(Multigrid, RefusesPointsThatFillNoGrid) {
  System system = fineWall(8);
  system.freeNodes = 100;
  EXPECT_THROW(makeMultigridMetric(system), Error);
}
