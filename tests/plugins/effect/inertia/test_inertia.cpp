// Scenes that are followed in time.
#include "tests/kernel/host/quiet_host.h"
#include "tests/plugins/solver/oscillator.h"
#include "tests/plugins/solver/wall.h"

#include "kernel/host/probe.h"
#include "kernel/host/settings.h"

using namespace pectora;

namespace {

// A solver that follows motions in time, and the order of its scheme: explicit ones damp by the velocity before the step, which is of
// order 1, and without damping both are the leapfrog's positions.
struct Follower {
  const char* id;
  std::string scheme;
  double order, dampedOrder;
};
class InTime : public testing::TestWithParam<Follower> {
 protected:
  // The largest distance of the mass on its spring from `exact` displacements over all moments, when the spring's end goes 1 mm.
  double errorOf(const Oscillator& o, double step, const std::function<double(double)>& exact) {
    auto solver = registry_.open(GetParam().id).descriptor->makeSolver();
    Settings settings{{"time_step", step}, {"max_iterations", 1e6}};
    if (!GetParam().scheme.empty()) settings.insert(settings.end(), {{"scheme", GetParam().scheme}, {"tolerance", 1e-10}});
    applySettings(settings, [&](Visitor& v) { solver->describe(v); });
    const Solution solution = solver->prepare(o.system, host_)->solve({{{Vec3{0, 0, 0}}, {Vec3{1, 0, 0}}}}, nullptr, host_);
    EXPECT_EQ(solution.status, SolveStatus::converged) << solution.message;
    double worst = 0;
    for (const Moment& m : solution.moments) worst = std::max(worst, std::abs(m.outer[0].x - Oscillator::kRest - exact(m.time)));
    EXPECT_NEAR(solution.moments.back().time, o.system.dynamics.duration, 1e-12);
    return worst;
  }
  void expectOrder(const Oscillator& o, double order, const std::function<double(double)>& exact) {
    const double coarse = errorOf(o, 2e-5, exact), fine = errorOf(o, 1e-5, exact);
    EXPECT_LT(fine, 0.05);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.2);
  }

  Registry registry_{{PECTORA_PLUGINS}};
  QuietHost host_;
};
INSTANTIATE_TEST_SUITE_P(Solver, InTime,
                         testing::Values(Follower{"solver.verlet", "", 2, 1}, Follower{"solver.semi_implicit", "", 2, 1},
                                         Follower{"solver.implicit", "euler", 1, 1}, Follower{"solver.implicit", "bdf2", 2, 2}),
                         [](const auto& follower) { return std::string(follower.param.id).substr(7) + follower.param.scheme; });

void setMotion(Wall& wall, double duration, double lifting, double damping) {
  wall.scene->effects.push_back(call("effect.inertia", {{"duration", duration}, {"lifting", lifting}, {"damping", damping}, {"interval", 0.01}}));
}

}  // namespace

TEST_P(InTime, FollowsABarThatComesSoftly) {
  // x'' = w^2 (u(t) - x) with u = 3 s^2 - 2 s^3 and s = t / T: up to T it is u - u'' / w^2 and a free swing, then a free swing about 1.
  Oscillator o;
  const double w = o.omega(), T = 1.3 / w * 2;
  o.system.dynamics = {.duration = 0.016, .lifting = T, .interval = 0.0005};
  const auto lifted = [&](double t, double& speed) {
    const double s = t / T, a = 6 / (T * T * w * w), b = 12 / (T * T * T * w * w * w);   // they make it start at rest
    speed = 6 * s * (1 - s) / T + 12 / (T * T * T * w * w) + w * (-a * std::sin(w * t) - b * std::cos(w * t));
    return s * s * (3 - 2 * s) - (6 - 12 * s) / (T * T * w * w) + a * std::cos(w * t) - b * std::sin(w * t);
  };
  expectOrder(o, GetParam().order, [&](double t) {
    double speed = 0;
    const double x = lifted(std::min(t, T), speed), since = t - std::min(t, T);
    return 1 + (x - 1) * std::cos(w * since) + speed / w * std::sin(w * since);
  });
}

TEST_P(InTime, FollowsABarThatIsThereAtOnceAndTheDampedSwing) {
  Oscillator o;
  const double decay = 60, w = std::sqrt(o.omega() * o.omega() - decay * decay);
  o.system.dynamics = {.duration = 0.016, .interval = 0.0005, .damping = 2 * decay};
  expectOrder(o, GetParam().dampedOrder, [&](double t) { return 1 - std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t)); });
}

TEST_P(InTime, EndsWhereTheWallRestsAndLosesItsEnergyToDamping) {
  Wall wall(10);
  const auto rest = Solve("solver.newton")(wall, {{"tolerance", 1e-8}});
  setMotion(wall, 1.5, 0.05, 40);
  Settings settings{{"max_iterations", 1e6}};
  if (!GetParam().scheme.empty()) settings.insert(settings.end(), {{"scheme", GetParam().scheme}, {"time_step", 0.002}});
  const auto motion = Solve(GetParam().id)(wall, settings);
  EXPECT_EQ(motion->moments.size(), 151u);
  EXPECT_LT(largestDifference(motion->outer, rest->outer), 0.01);
  EXPECT_EQ(motion->moments.back().outer, motion->outer);
  // From the bar's arrival on the whole energy falls, but for the ripple of explicit steps.
  double before = INFINITY;
  for (const Moment& m : motion->moments) {
    if (m.time < 0.05) continue;
    EXPECT_LE(m.energy + m.kineticEnergy, before * 1.01) << m.time;
    before = m.energy + m.kineticEnergy;
  }
}

TEST(InTime, TwoSchemesTellTheSameWayOfAWall) {
  Wall wall(10);
  setMotion(wall, 0.06, 0.02, 0);
  const auto one = Solve("solver.verlet")(wall, {{"max_iterations", 1e6}});
  const auto other = Solve("solver.implicit")(wall, {{"scheme", std::string("bdf2")}, {"time_step", 1e-4}, {"max_iterations", 1e6}});
  ASSERT_EQ(one->moments.size(), other->moments.size());
  double swing = 0;
  for (std::size_t i = 0; i < one->moments.size(); ++i) {
    EXPECT_LT(largestDifference(one->moments[i].outer, other->moments[i].outer), 0.1) << one->moments[i].time;
    swing = std::max(swing, largestDifference(one->moments[i].outer, one->outer));
  }
  EXPECT_GT(swing, 5);   // what is compared moves
}

TEST(InTime, ASceneWithoutADurationIsSolvedAtRest) {
  Registry registry({PECTORA_PLUGINS});
  Wall wall(10), plain(10);
  wall.scene->effects.push_back(call("effect.inertia"));
  const Compiled compiled = compile(*wall.scene, registry);
  EXPECT_FALSE(compiled.effects.back().isActive);
  EXPECT_FALSE(compiled.system->dynamics.isAskedFor());
  EXPECT_EQ(Solve("solver.newton")(wall, {})->outer, Solve("solver.newton")(plain, {})->outer);
}

TEST(InTime, SolversThatFindRestAloneAreRefusedByName) {
  Wall wall(10);
  setMotion(wall, 0.1, 0, 0);
  for (const char* id : {"solver.newton", "solver.lbfgs", "solver.multigrid", "solver.projective", "solver.xpbd"}) {
    Solve solve(id);
    const Error error = errorOf([&] { solve(wall, {}); });
    EXPECT_TRUE(contains(error.what(), id)) << error.what();
    EXPECT_TRUE(contains(error.what(), "effect.inertia")) << error.what();
    EXPECT_EQ(error.kind(), ErrorKind::badInput);
  }
}

TEST(InTime, TooManyStepsAreRefusedWithTheirNumber) {
  Wall wall(10);
  setMotion(wall, 100, 0, 0);
  Solve solve("solver.implicit");
  const Error error = errorOf([&] { solve(wall, {{"time_step", 0.01}}); });
  EXPECT_TRUE(contains(error.what(), "10000 steps of 0.01 s")) << error.what();
}

TEST(InTime, WeightBeginsFromTheShapeOfTheCt) {
  // The posture stays as it was: the shape without load is found at rest, and nothing swings.
  Wall wall(0);
  wall.scene->effects.push_back(call("effect.gravity", {{"ct_posture", std::string("supine")}, {"posture", std::string("supine")}, {"acceleration", 1.0}}));
  Solve solve("solver.verlet");
  const auto rest = solve(wall, {});
  setMotion(wall, 0.5, 0, 50);
  const auto motion = solve(wall, {{"max_iterations", 1e6}});
  EXPECT_LT(largestDifference(motion->outer, rest->outer), 0.05);
}

TEST(InTime, ProbesOfOtherEffectsAreMadeAtRest) {
  Wall wall(10);
  const auto stretch = [&](const Probe& probe) { return probe.effects.front().changeRms; };
  Registry registry({PECTORA_PLUGINS});
  QuietHost host;
  const double atRest = stretch(probeEffects(*wall.scene, *wall.plan, registry, host));
  setMotion(wall, 100, 0, 0);
  const Probe probe = probeEffects(*wall.scene, *wall.plan, registry, host);
  EXPECT_EQ(stretch(probe), atRest);
  EXPECT_GT(atRest, 0);
  EXPECT_TRUE(contains(probe.effects.back().notProbed, "way in time"));
}
