#include "plugins/solver/verlet/verlet.h"

#include "kernel/physics/springs.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pectora;

namespace {

constexpr double kRest = 10;   // mm

// One mass on a spring to a driven node at the origin, moving along x.
System oscillator(double massKg, double stiffness) {
  System system;
  system.rows = 1;
  system.columns = 1;
  system.freeNodes = 1;
  system.rest = NodeVectors(2);
  system.rest.set(0, {kRest, 0, 0});
  system.mass = {massKg};
  system.terms.push_back(makeSpringTerm("spring", system, {{0, 1, stiffness}}));
  return system;
}

NodeVectors stretched(const System& system, double amplitude) {
  NodeVectors x = system.rest;
  x.set(0, {kRest + amplitude, 0, 0});
  return x;
}

// Largest distance from the true undamped motion over `time` seconds.
double errorOver(double time, int steps) {
  const double mass = 0.002, k = 0.8, omega = std::sqrt(1000 * k / mass);
  const System system = oscillator(mass, k);
  const double h = time / steps;
  Verlet verlet(system, system.mass, stretched(system, 1), h);
  double error = 0;
  for (int n = 1; n <= steps; ++n) {
    verlet.step(0);
    error = std::max(error, std::abs(verlet.positions().x[0] - kRest - std::cos(omega * n * h)));
  }
  return error;
}

}  // namespace

TEST(Verlet, OscillatesAtExactlyItsDiscreteFrequency) {
  // The scheme's own frequency is (2 / h) asin(w h / 2); from rest its solution is A cos(w_h n h).
  const double mass = 0.002, k = 0.8, omega = std::sqrt(1000 * k / mass), h = 0.9 / omega;
  const double discrete = 2 / h * std::asin(omega * h / 2);
  const System system = oscillator(mass, k);
  Verlet verlet(system, system.mass, stretched(system, 1), h);
  for (int n = 1; n <= 1000; ++n) {
    verlet.step(0);
    // Rounding of x = 11 mm (2e-15) grows with n squared at most.
    ASSERT_NEAR(verlet.positions().x[0] - kRest, std::cos(discrete * n * h), 2e-9) << "step " << n;
  }
}

TEST(Verlet, IsOfSecondOrder) {
  const double coarse = errorOver(0.05, 400), fine = errorOver(0.05, 800), finest = errorOver(0.05, 1600);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.2);
  EXPECT_NEAR(std::log2(fine / finest), 2, 0.2);
}

TEST(Verlet, KeepsItsEnergyBoundedWithoutDamping) {
  const double mass = 0.002, k = 0.8, omega = std::sqrt(1000 * k / mass);
  const System system = oscillator(mass, k);
  Verlet verlet(system, system.mass, stretched(system, 1), 0.5 / omega);
  double greatest = 0;
  for (int n = 0; n < 100000; ++n) {
    verlet.step(0);
    greatest = std::max(greatest, verlet.energy());
  }
  EXPECT_LT(greatest, 0.5 * k * 1.001);
}

TEST(Verlet, IsStableJustBelowItsLimitAndNotJustAbove) {
  const double mass = 0.002, k = 0.8, omega = std::sqrt(1000 * k / mass);
  const System system = oscillator(mass, k);
  for (const double damping : {0.0, 0.4 * omega, 2 * omega}) {
    const double limit = stableStep(omega, damping);
    const auto amplitudeAfter = [&](double h) {
      Verlet verlet(system, system.mass, stretched(system, 1e-3), h);
      for (int n = 0; n < 3000; ++n) verlet.step(damping);
      return std::abs(verlet.positions().x[0] - kRest);
    };
    EXPECT_LT(amplitudeAfter(0.99 * limit), 0.01) << damping;
    const double above = amplitudeAfter(1.01 * limit);
    EXPECT_TRUE(!(above < 1)) << damping << " " << above;
  }
}

TEST(Verlet, LimitOfOneOscillatorIsTwoOverOmega) {
  const System system = oscillator(0.002, 0.8);
  EXPECT_NEAR(frequencyBoundSquared(system, system.mass), 1000 * 0.8 / 0.002, 1e-9);
  EXPECT_NEAR(stableStep(100, 0), 0.02, 1e-15);
  // Lagged damping of ratio 1 leaves sqrt(2) - 1 of it.
  EXPECT_NEAR(stableStep(100, 200), 0.02 * (std::sqrt(2.0) - 1), 1e-15);
}

TEST(Verlet, SeesTheStiffnessOfItsMotion) {
  const double mass = 0.002, k = 0.8;
  const System system = oscillator(mass, k);
  Verlet verlet(system, system.mass, stretched(system, 1), 1e-3);
  verlet.step(0);
  EXPECT_EQ(verlet.rayleighQuotient(), 0);
  verlet.step(0);
  EXPECT_NEAR(verlet.rayleighQuotient(), 1000 * k / mass, 1e-6);
}
