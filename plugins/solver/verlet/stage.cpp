#include "plugins/solver/verlet/verlet.h"

#include "kernel/stage/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace {
using namespace pectora;

struct Settings {
  double timeStep = 0, damping = 0, tolerance = 1e-4;
  int maxIterations = 20000, ramp = 100;
  std::string mass = "scaled";
};

// Largest force on a free node, and which.
struct Residual {
  double force = 0;
  std::size_t node = 0;
};

Residual largestResidual(const System& system, const NodeVectors& gradient) {
  Residual r;
  for (std::size_t i = 0; i < system.freeNodes; ++i) {
    const double force = norm(gradient[i]);
    if (!(force <= r.force)) r = {force, i};  // takes a NaN, too
    if (std::isnan(force)) break;
  }
  return r;
}

class VerletSession final : public Session {
 public:
  VerletSession(const System& system, Settings settings, std::vector<double> mass, double step, double frequencyBound)
      : system_(system), settings_(settings), mass_(std::move(mass)), step_(step), frequencyBound_(frequencyBound) {}

  Solution solve(const Drive& drive, const NodeVectors* start, Host& host) override {
    Verlet verlet(system_, mass_, start ? *start : system_.rest, step_);
    Solution solution;
    double damping = settings_.damping, slowest = 0;
    double leastResidual = INFINITY;
    int leastAt = 0;
    NodeVectors lastGood = verlet.positions();

    for (int n = 1; n <= settings_.maxIterations; ++n) {
      const double t = settings_.ramp > 0 ? std::min(1.0, double(n) / settings_.ramp) : 1;
      drive.apply(t, system_.freeNodes, verlet.positions());
      const NodeVectors here = t >= 1 && n % 20 == 0 ? verlet.positions() : NodeVectors();
      verlet.step(damping);
      solution.iterations = n;

      // The best damping is critical for the slowest mode, which the motion itself shows.
      if (settings_.damping == 0) {
        const double seen = std::sqrt(verlet.rayleighQuotient());
        slowest = n < 10 ? seen : 0.95 * slowest + 0.05 * seen;
        damping = std::min(2 * slowest, 0.5 * frequencyBound_);
      }
      if (n % 20 != 0) continue;

      // Judge the forces of every twentieth state once the bar is in place.
      host.checkCancel();
      const Residual residual = largestResidual(system_, verlet.gradient());
      if (!std::isfinite(residual.force) || !std::isfinite(verlet.energy())) {
        solution.status = SolveStatus::diverged;
        solution.message = "a force at the " + system_.nodeName(residual.node) + " is not finite";
        break;
      }
      solution.energyHistory.push_back(verlet.energy());
      if (here.size() == 0) continue;
      lastGood = here;
      record(solution, verlet, residual);
      host.progress(progress(solution.relativeResidual), fmt::format("step {}, residual {:.1e}", n, solution.relativeResidual));
      if (residual.force <= settings_.tolerance * verlet.largestForce() || residual.force < 1e-12) {
        solution.status = SolveStatus::converged;
        break;
      }
      if (residual.force < 0.99 * leastResidual) leastResidual = residual.force, leastAt = n;
      if (n - leastAt > std::max(2000, settings_.maxIterations / 4)) {
        solution.status = SolveStatus::stalled;
        solution.message = "the largest force stays at the " + system_.nodeName(residual.node);
        break;
      }
    }
    if (solution.status == SolveStatus::stalled && solution.message.empty())
      solution.message = fmt::format("{} steps were not enough", settings_.maxIterations);
    solution.positions = std::move(lastGood);
    solution.forceEvaluations = verlet.evaluations();
    return solution;
  }

 private:
  void record(Solution& solution, const Verlet& verlet, const Residual& residual) const {
    solution.residual = residual.force;
    solution.relativeResidual = verlet.largestForce() > 0 ? residual.force / verlet.largestForce() : 0;
    solution.energy = verlet.energy();
  }
  // Decades of the residual from 1 to the tolerance.
  double progress(double relative) const {
    return std::clamp(std::log(std::max(relative, 1e-300)) / std::log(settings_.tolerance), 0.0, 1.0);
  }

  const System& system_;
  Settings settings_;
  std::vector<double> mass_;
  double step_, frequencyBound_;
};

class VerletSolver final : public Solver {
 public:
  void describe(Visitor& v) override {
    v.real("tolerance", settings_.tolerance, "", {1e-12, 0.5}, {1e-6, 1e-2}, "Stop when the largest force on a free point is this part of the largest spring force");
    v.integer("max_iterations", settings_.maxIterations, "", {1, 1e8}, {1000, 50000}, "Stop unconverged after so many steps");
    v.integer("ramp", settings_.ramp, "", {0, 1e7}, {0, 1000}, "Steps over which the bar is brought to its place");
    v.real("time_step", settings_.timeStep, "s", {0, 10}, {0, 0.01}, "Step; refused beyond the stability limit; 0: nine tenths of it");
    v.real("damping", settings_.damping, "1/s", {0, 1e9}, {0, 1000}, "Velocity damping c in a = F/m - c v; 0: critical for the slowest mode seen");
    v.choice("mass", settings_.mass, {"scaled", "tissue"}, "Masses of the points: in proportion to their stiffness, which is fastest and gives the same end, or the tissue's own");
  }

  std::unique_ptr<Session> prepare(const System& system, Host&) override {
    std::vector<double> mass = system.mass;
    if (settings_.mass == "scaled") {
      // The same frequency bound at every node, with the mean of the tissue's masses.
      const std::vector<double> stiffness = system.stiffnessBound();
      double stiffnessSum = 0, massSum = 0;
      for (std::size_t i = 0; i < system.freeNodes; ++i) stiffnessSum += stiffness[i], massSum += mass[i];
      for (std::size_t i = 0; i < system.freeNodes; ++i) mass[i] = massSum * stiffness[i] / stiffnessSum;
    }
    const double bound = std::sqrt(frequencyBoundSquared(system, mass));
    // With automatic damping the limit is that of the greatest damping it may choose.
    const double limit = stableStep(bound, settings_.damping > 0 ? settings_.damping : 0.5 * bound);
    if (settings_.timeStep > limit)
      throw Error("the step is beyond the stability limit of the Verlet scheme")
          .of("time_step").given(fmt::format("{:g} s", settings_.timeStep)).allowed(fmt::format("up to {:.6g} s for this scene", limit)).advise("Leave it 0 for a safe step");
    const double step = settings_.timeStep > 0 ? settings_.timeStep : 0.9 * limit;
    return std::make_unique<VerletSession>(system, settings_, std::move(mass), step, bound);
  }

 private:
  Settings settings_;
};

}  // namespace

PECTORA_SOLVER(VerletSolver, {.id = "solver.verlet", .version = "1.0",
                              .summary = "The paper's explicit Verlet integration, damped until the wall is at rest",
                              .references = "Moreira et al., SPIE 2012, eq. 1-3; Underwood 1983 for the damping"})
