#include "plugins/solver/semi_implicit/semi_implicit.h"

#include "tests/plugins/solver/oscillator.h"
#include "tests/plugins/solver/wall.h"

using namespace pectora;

namespace {

// Largest distance from the true undamped motion over `time` seconds.
double errorOver(double time, int steps) {
  const Oscillator o;
  const double h = time / steps;
  SemiImplicitEuler scheme(o.system, o.system.mass, o.stretched(1), h);
  double error = 0;
  for (int n = 1; n <= steps; ++n) {
    scheme.step(0);
    error = std::max(error, std::abs(scheme.positions().x[0] - Oscillator::kRest - std::cos(o.omega() * n * h)));
  }
  return error;
}

}  // namespace

TEST(SemiImplicitEuler, IsOfFirstOrder) {
  const double coarse = errorOver(0.05, 1600), fine = errorOver(0.05, 3200), finest = errorOver(0.05, 6400);
  EXPECT_NEAR(std::log2(coarse / fine), 1, 0.2);
  EXPECT_NEAR(std::log2(fine / finest), 1, 0.2);
}

TEST(SemiImplicitEuler, IsStableJustBelowItsLimitAndNotJustAbove) {
  const Oscillator o;
  for (const double damping : {0.0, 0.4 * o.omega(), 2 * o.omega()}) {
    const double limit = stableStep(o.omega(), damping);
    const auto amplitudeAfter = [&](double h) {
      SemiImplicitEuler scheme(o.system, o.system.mass, o.stretched(1e-3), h);
      for (int n = 0; n < 3000; ++n) scheme.step(damping);
      return std::abs(scheme.positions().x[0] - Oscillator::kRest);
    };
    EXPECT_LT(amplitudeAfter(0.99 * limit), 0.02) << damping;
    const double above = amplitudeAfter(1.01 * limit);
    EXPECT_TRUE(!(above < 1)) << damping << " " << above;
  }
}

TEST(SemiImplicitSolver, RefusesAStepBeyondItsLimitAndTellsTheLimit) {
  const Wall wall(10);
  Solve solve("solver.semi_implicit");
  const Error error = errorOf([&] { solve(wall, {{"time_step", 1.0}}); });
  EXPECT_TRUE(contains(error.what(), "stability limit of semi-implicit Euler")) << error.what();
  EXPECT_TRUE(contains(error.what(), "up to")) << error.what();
}
