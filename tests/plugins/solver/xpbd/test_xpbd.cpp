// Position-based dynamics: its order, and what shorter steps bring.
#include "tests/plugins/solver/wall.h"

using namespace pectora;

TEST(Xpbd, ComesNearerToTheLeastEnergyByTheSquareOfItsStep) {
  const Wall wall(5);
  const auto reference = Solve("solver.newton")(wall, {{"tolerance", 1e-10}});
  const auto error = [&](double step) {
    // The tolerance is out of its reach, so that it goes on until it moves no more.
    const auto motion = Solve("solver.xpbd")(wall, {{"step", step}, {"tolerance", 1e-12}, {"max_iterations", 40000.0}, {"accept_unconverged", true}});
    return largestDifference(motion->outer, reference->outer);
  };
  const double coarse = error(0.8), middle = error(0.4), fine = error(0.2);
  EXPECT_NEAR(std::log2(coarse / middle), 2, 0.4);
  EXPECT_NEAR(std::log2(middle / fine), 2, 0.4);
}

TEST(Xpbd, HalvesItsStepsUntilTheToleranceIsKept) {
  const Wall wall(20);
  const auto motion = Solve("solver.xpbd")(wall, {{"tolerance", 1e-4}});
  EXPECT_EQ(motion->status, SolveStatus::converged);
  EXPECT_LE(motion->relativeResidual, 1e-4);
  // Forces of some 1 N and a least stiffness of some 0.02 N/mm.
  EXPECT_LT(largestDifference(motion->outer, Solve("solver.newton")(wall, {{"tolerance", 1e-10}})->outer), 0.02);
}

TEST(Xpbd, WithAFixedStepSaysThatItComesNoNearer) {
  const auto motion = Solve("solver.xpbd")(Wall(20), {{"step", 2.0}, {"tolerance", 1e-8}, {"accept_unconverged", true}});
  EXPECT_EQ(motion->status, SolveStatus::stalled);
  EXPECT_TRUE(contains(motion->message, "steps of 2 come no nearer")) << motion->message;
}

TEST(Xpbd, TakesWeightButNoSolidCells) {
  Wall wall(10);
  wall.scene->effects.push_back(call("effect.gravity", {{"ct_posture", std::string("none")}}));
  const auto motion = Solve("solver.xpbd")(wall, {{"tolerance", 1e-4}});
  EXPECT_LT(largestDifference(motion->outer, Solve("solver.newton")(wall, {{"tolerance", 1e-8}})->outer), 0.02);
  wall.scene->effects.push_back(call("effect.volume"));
  EXPECT_TRUE(contains(errorOf([&] { Solve("solver.xpbd")(wall, {}); }).what(), "effect.volume"));
}
