#include "plugins/solver/implicit/implicit.h"

#include "tests/plugins/solver/oscillator.h"

#include <gtest/gtest.h>

using namespace pectora;

namespace {

constexpr Minimiser::Limits kTight{1e-12, 50};

// Distance from the true motion x'' = -w^2 x - c x' at the end of `time` seconds; c is below critical.
double errorAt(double time, int steps, ImplicitScheme scheme, double damping) {
  const Oscillator o;
  ImplicitStepper stepper(o.system, o.system.mass, o.stretched(1), time / steps, damping, scheme);
  for (int n = 0; n < steps; ++n) stepper.step(kTight, {});
  const double decay = damping / 2, omega = std::sqrt(o.omega() * o.omega() - decay * decay);
  const double exact = std::exp(-decay * time) * (std::cos(omega * time) + decay / omega * std::sin(omega * time));
  return std::abs(stepper.positions().x[0] - Oscillator::kRest - exact);
}

void expectOrder(ImplicitScheme scheme, double order) {
  for (const double damping : {0.0, 200.0}) {
    const double coarse = errorAt(0.012, 800, scheme, damping), fine = errorAt(0.012, 1600, scheme, damping), finest = errorAt(0.012, 3200, scheme, damping);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.2) << damping;
    EXPECT_NEAR(std::log2(fine / finest), order, 0.2) << damping;
  }
}

}  // namespace

TEST(ImplicitStepper, BackwardEulerIsOfFirstOrder) { expectOrder(ImplicitScheme::backwardEuler, 1); }

TEST(ImplicitStepper, Bdf2IsOfSecondOrder) { expectOrder(ImplicitScheme::bdf2, 2); }

TEST(ImplicitStepper, BackwardEulerDampsAsItsFormulaSays) {
  // |amplification| = (1 + h^2 w^2)^(-1/2) a step, for the motion of position and velocity together.
  const Oscillator o;
  const double h = 0.3 / o.omega();
  ImplicitStepper stepper(o.system, o.system.mass, o.stretched(1), h, 0, ImplicitScheme::backwardEuler);
  const auto amplitude = [&] {
    return std::hypot(stepper.positions().x[0] - Oscillator::kRest, stepper.velocity().x[0] / o.omega());
  };
  for (int n = 0; n < 20; ++n) {
    const double before = amplitude();
    stepper.step(kTight, {});
    EXPECT_NEAR(amplitude() / before, 1 / std::sqrt(1 + 0.09), 1e-8);
  }
}

TEST(ImplicitStepper, IsStableFarBeyondTheExplicitLimit) {
  const Oscillator o;
  for (const ImplicitScheme scheme : {ImplicitScheme::backwardEuler, ImplicitScheme::bdf2}) {
    ImplicitStepper stepper(o.system, o.system.mass, o.stretched(1), 100 / o.omega(), 0, scheme);
    for (int n = 0; n < 50; ++n) stepper.step(kTight, {});
    EXPECT_NEAR(stepper.positions().x[0], Oscillator::kRest, 1e-6);
  }
}
