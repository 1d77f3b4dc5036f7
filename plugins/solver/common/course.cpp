#include "plugins/solver/common/course.h"

#include "plugins/solver/common/movement.h"
#include "plugins/solver/common/node_algebra.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr double kGrowth = 0.05;      // of the energy, more than the ripple of explicit steps
constexpr int kMostHalvings = 10;
constexpr double kMmPerM = 1000;      // N / kg is m/s^2

// What is seen of a traveller when it stops to look about.
struct Look {
  Moment moment;
  double largestForce = 0;
  Residual residual;
  bool isFinite() const { return std::isfinite(moment.energy) && std::isfinite(moment.kineticEnergy) && std::isfinite(residual.force); }
};

Look lookAt(const System& system, Traveller& traveller, double time) {
  Look look;
  NodeVectors gradient(system.rest.size());
  look.moment.time = time;
  look.moment.energy = system.evaluate(traveller.positions(), gradient, look.largestForce);
  look.residual = largestResidual(system, gradient);
  const NodeVectors velocity = traveller.velocity(gradient);
  for (std::size_t i = 0; i < system.freeNodes; ++i) look.moment.kineticEnergy += 0.5 * system.mass[i] * dot(velocity[i], velocity[i]) / kMmPerM;
  look.moment.fastest = longest(velocity, system.freeNodes);
  for (std::size_t i = 0; i < system.points(); ++i) look.moment.outer.push_back(traveller.positions()[system.node(0, i)]);
  return look;
}

// One try with steps of one length.
Solution followOnce(const System& system, const Movement& movement, int stepsAnInterval, int intervals, const MakeTraveller& make, Host& host) {
  const Dynamics& dynamics = system.dynamics;
  const double h = dynamics.interval / stepsAnInterval;
  const Guide guide = [&](double time, NodeVectors& positions) {
    const double s = dynamics.lifting > 0 ? std::clamp(time / dynamics.lifting, 0.0, 1.0) : 1;
    movement.apply(s * s * (3 - 2 * s), positions);
  };
  const auto traveller = make(movement.beginning(), h);
  guide(0, traveller->positions());

  Solution solution;
  solution.positions = movement.beginning();
  solution.status = SolveStatus::converged;
  double total = INFINITY;   // potential and kinetic energy when last looked at with the driven nodes in place
  int inexact = 0;
  for (int k = 0; k <= intervals; ++k) {
    Outcome outcome = Outcome::converged;
    for (int n = 0; k > 0 && n < stepsAnInterval && outcome != Outcome::diverged; ++n, ++solution.iterations) {
      if (n % 20 == 0) host.checkCancel();
      outcome = traveller->step(guide);
      inexact += outcome == Outcome::stalled;
    }
    Look look = lookAt(system, *traveller, k * dynamics.interval);
    solution.forceEvaluations = traveller->evaluations() + k + 1;
    if (outcome == Outcome::diverged || !look.isFinite()) {
      solution.status = SolveStatus::diverged;
      solution.message = fmt::format("a force at the {} is not finite after {:g} s", system.nodeName(look.residual.node), look.moment.time);
      break;
    }
    const double now = look.moment.energy + look.moment.kineticEnergy;
    if (look.moment.time >= dynamics.lifting) {
      if (total > 0) solution.energyGrowth = std::max(solution.energyGrowth, (now - total) / total);
      total = now;
    }
    if (solution.energyGrowth > kGrowth) {
      solution.status = SolveStatus::diverged;
      solution.message = fmt::format("the energy grew by {:.0f} % up to {:g} s: the time step is too long for a wall so distorted", 100 * solution.energyGrowth, look.moment.time);
      break;
    }
    solution.positions = traveller->positions();
    solution.energy = look.moment.energy;
    solution.energyHistory.push_back(look.moment.energy);
    solution.residual = look.residual.force;
    solution.relativeResidual = look.largestForce > 0 ? look.residual.force / look.largestForce : 0;
    host.preview(solution.positions);
    host.progress(double(k) / intervals, fmt::format("{:.3g} of {:.3g} s", look.moment.time, dynamics.duration));
    solution.moments.push_back(std::move(look.moment));
  }
  if (inexact > 0 && solution.status == SolveStatus::converged)
    solution.message = fmt::format("{} of {} steps in time did not reach their tolerance", inexact, solution.iterations);
  return solution;
}

}  // namespace

Solution follow(const System& system, const Drive& drive, const NodeVectors* start, CourseSettings settings, const MakeTraveller& make, Host& host) {
  const Dynamics& dynamics = system.dynamics;
  const Movement movement(system, drive, start);
  const double intervals = std::ceil(dynamics.duration / dynamics.interval - 1e-9), perInterval = std::ceil(dynamics.interval / settings.longestStep - 1e-9);
  if (intervals * perInterval > settings.mostSteps)
    throw Error("the motion in time takes more steps than are allowed")
        .of("max_iterations").given(fmt::format("{:.0f} steps of {:.3g} s", intervals * perInterval, dynamics.interval / perInterval))
        .allowed(fmt::format("up to {}", settings.mostSteps)).advise("Follow a shorter time, allow more steps, or take solver.implicit, whose steps may be longer");
  Solution solution;
  int evaluations = 0;
  double steps = perInterval;   // in every interval
  for (int halvings = 0;; ++halvings, steps *= 2) {
    if (halvings > 0) host.info(fmt::format("followed anew with steps of {:.3g} s", dynamics.interval / steps));
    solution = followOnce(system, movement, int(steps), int(intervals), make, host);
    evaluations += solution.forceEvaluations;
    const bool mayHalve = settings.mayHalve && halvings < kMostHalvings && 2 * steps * intervals <= settings.mostSteps;
    if (solution.status != SolveStatus::diverged || !mayHalve) break;
  }
  solution.forceEvaluations = evaluations;
  return solution;
}

}  // namespace pectora
