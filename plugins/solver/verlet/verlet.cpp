#include "plugins/solver/verlet/verlet.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr double kMmPerM = 1000;  // N / kg is m/s^2

}  // namespace

double frequencyBoundSquared(const System& system, const std::vector<double>& mass) {
  const std::vector<double> stiffness = system.stiffnessBound();
  double bound = 0;
  for (std::size_t i = 0; i < system.freeNodes; ++i) bound = std::max(bound, stiffness[i] / mass[i] * kMmPerM);
  return bound;
}

double stableStep(double frequencyBound, double damping) {
  const double z = damping / (2 * frequencyBound);
  return 2 / frequencyBound * (std::sqrt(1 + z * z) - z);
}

Verlet::Verlet(const System& system, std::vector<double> mass, NodeVectors start, double step)
    : system_(system), mass_(std::move(mass)), step_(step), now_(std::move(start)), before_(now_),
      gradient_(system.rest.size()), gradientBefore_(system.rest.size()) {}

void Verlet::evaluate() {
  energy_ = system_.evaluate(now_, gradient_, largestForce_);
  ++evaluations_;
}

void Verlet::step(double damping) {
  std::swap(gradient_, gradientBefore_);
  evaluate();

  // Rayleigh quotient of the last displacement: dx . dg / dx . M dx.
  double change = 0, moved = 0;
  for (std::size_t i = 0; i < system_.freeNodes; ++i) {
    const Vec3 dx = now_[i] - before_[i];
    change += dot(dx, gradient_[i] - gradientBefore_[i]);
    moved += mass_[i] * dot(dx, dx);
  }
  rayleigh_ = started_ && moved > 0 ? std::max(0.0, change / moved) * kMmPerM : 0;

  const double h = step_;
  for (std::size_t i = 0; i < system_.freeNodes; ++i) {
    const Vec3 x = now_[i];
    const Vec3 free = gradient_[i] * (-kMmPerM / mass_[i]);
    // From rest, the point before the start is mirrored: x(-h) = x0 + h^2 a0 / 2.
    const Vec3 previous = started_ ? before_[i] : x + free * (0.5 * h * h);
    const Vec3 velocity = (x - previous) / h;
    const Vec3 acceleration = free - velocity * damping;
    before_.set(i, x);
    now_.set(i, x + (x - previous) + acceleration * (h * h));
  }
  started_ = true;
}

}  // namespace pectora
