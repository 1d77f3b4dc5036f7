#include "plugins/solver/implicit/implicit.h"

namespace pectora {
namespace {

constexpr double kMmPerM = 1000;  // N / kg is m/s^2

}  // namespace

ImplicitStepper::ImplicitStepper(const System& system, std::vector<double> mass, NodeVectors start, double step, double damping,
                                 ImplicitScheme scheme)
    : system_(system), mass_(std::move(mass)), step_(step), damping_(damping), scheme_(scheme), objective_(system), rest_(system),
      newton_(system), now_(std::move(start)), before_(now_), velocity_(now_.size()), velocityBefore_(velocity_) {
  inertia_.weight.resize(system.freeNodes);
  inertia_.target = NodeVectors(system.freeNodes);
  objective_.setInertia(&inertia_);
}

void ImplicitStepper::aim(bool isBdf2) {
  const double a = (isBdf2 ? 1.5 : 1) / step_, ac = a + damping_;
  for (std::size_t i = 0; i < system_.freeNodes; ++i) {
    const Vec3 s = isBdf2 ? (now_[i] * 4 - before_[i]) / (2 * step_) : now_[i] / step_;
    const Vec3 u = isBdf2 ? (velocity_[i] * 4 - velocityBefore_[i]) / (2 * step_) : velocity_[i] / step_;
    inertia_.weight[i] = mass_[i] / kMmPerM * a * ac;
    inertia_.target.set(i, (s * ac + u) / (a * ac));
  }
}

Outcome ImplicitStepper::step(Minimiser::Limits limits, const Watch& watch) {
  const bool isBdf2 = scheme_ == ImplicitScheme::bdf2 && steps_ > 0;
  aim(isBdf2);
  NodeVectors next = now_;
  const Outcome outcome = newton_.minimise(objective_, next, inner_, limits, iterations_, watch);
  if (outcome == Outcome::diverged) return outcome;
  std::swap(velocity_, velocityBefore_);
  for (std::size_t i = 0; i < system_.freeNodes; ++i)
    velocity_.set(i, isBdf2 ? (next[i] * 3 - now_[i] * 4 + before_[i]) / (2 * step_) : (next[i] - now_[i]) / step_);
  before_ = std::move(now_);
  now_ = std::move(next);
  ++steps_;
  return outcome;
}

const Evaluation& ImplicitStepper::evaluateRest() {
  rest_.evaluate(now_, atRest_);
  return atRest_;
}

}  // namespace pectora
