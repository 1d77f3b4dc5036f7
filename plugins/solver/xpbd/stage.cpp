#include "plugins/solver/xpbd/xpbd.h"

#include "plugins/solver/common/movement.h"
#include "plugins/solver/common/node_algebra.h"

#include "kernel/stage/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace {
using namespace pectora;

constexpr double kFirstStep = 2, kLeastStep = 0.01;   // automatic steps begin and end there
constexpr int kLook = 20;                             // steps between two looks at the forces
constexpr int kPatience = 10;                         // looks without a smaller residual, at steps of 1, before steps are halved

struct Settings {
  double tolerance = 1e-3, step = 0;
  int maxIterations = 50000, ramp = 100;
};

class XpbdSession final : public Session {
 public:
  XpbdSession(const System& system, const Settings& settings) : system_(system), settings_(settings) {}

  Solution solve(const Drive& drive, const NodeVectors* start, Host& host) override {
    const Movement movement(system_, drive, start);
    Xpbd xpbd(system_, movement.beginning());
    Solution solution;
    solution.positions = xpbd.positions();
    NodeVectors gradient(system_.rest.size());
    const double negligible = negligibleForce(system_);
    double h = settings_.step > 0 ? settings_.step : kFirstStep, least = INFINITY;
    double total = INFINITY;   // potential and kinetic energy when last looked at with the bar in place and steps of this length
    int looksSinceLeast = 0;
    for (int n = 1; n <= settings_.maxIterations; ++n) {
      const double t = settings_.ramp > 0 ? std::min(1.0, double(n) / settings_.ramp) : 1;
      movement.apply(t, xpbd.positions());
      xpbd.step(h);
      solution.iterations = n;
      if (n % kLook != 0) continue;

      // What the springs really do there.
      host.checkCancel();
      double largest = 0;
      const double energy = system_.evaluate(xpbd.positions(), gradient, largest);
      ++solution.forceEvaluations;
      const Residual residual = largestResidual(system_, gradient);
      if (!std::isfinite(energy) || !std::isfinite(residual.force)) {
        solution.status = SolveStatus::diverged;
        solution.message = "a force at the " + system_.nodeName(residual.node) + " is not finite";
        break;
      }
      solution.positions = xpbd.positions();
      solution.energyHistory.push_back(energy);
      solution.energy = energy;
      solution.residual = residual.force;
      solution.relativeResidual = largest > 0 ? residual.force / largest : 0;
      host.preview(solution.positions);
      host.progress(std::clamp(std::log(std::max(solution.relativeResidual, 1e-300)) / std::log(settings_.tolerance), 0.0, 1.0),
                    fmt::format("step {}, residual {:.1e}", n, solution.relativeResidual));
      if (t < 1) continue;
      const double now = energy + xpbd.kineticEnergy();
      if (total > 0) solution.energyGrowth = std::max(solution.energyGrowth, (now - total) / total);
      total = now;
      if (residual.force <= settings_.tolerance * largest || residual.force <= negligible) {
        solution.status = SolveStatus::converged;
        break;
      }
      if (residual.force < 0.98 * least) least = residual.force, looksSinceLeast = 0;
      else if (++looksSinceLeast * std::min(h, 1.0) >= kPatience) {   // shorter steps take longer to come anywhere
        // As near as steps of this length come.
        looksSinceLeast = 0;
        least = INFINITY;
        if (settings_.step > 0 || h < kLeastStep) {
          solution.message = fmt::format("steps of {:g} come no nearer to rest; the largest force stays at the {}", h, system_.nodeName(residual.node));
          break;
        }
        h *= 0.5;
        total = INFINITY;
      }
    }
    if (solution.status == SolveStatus::stalled && solution.message.empty())
      solution.message = fmt::format("{} steps were not enough", settings_.maxIterations);
    solution.forceEvaluations += solution.iterations;   // a pass over the springs costs about as much
    return solution;
  }

 private:
  const System& system_;
  Settings settings_;
};

class XpbdSolver final : public Solver {
 public:
  void describe(Visitor& v) override {
    v.real("tolerance", settings_.tolerance, "", {1e-12, 0.5}, {1e-4, 1e-2}, "Stop when the largest force on a free point is this part of the largest spring force");
    v.integer("max_iterations", settings_.maxIterations, "", {1, 1e8}, {1000, 100000}, "Stop unconverged after so many steps");
    v.real("step", settings_.step, "", {0, 1e6}, {0, 4}, "Length of a step, times the greatest angular frequency: the end is off the least energy by its square; 0: 2, and halved whenever no nearer can be come");
    v.integer("ramp", settings_.ramp, "", {0, 1e7}, {0, 1000}, "Steps over which the bar is brought to its place");
  }
  Needs needs() const override { return {.springs = true}; }
  std::unique_ptr<Session> prepare(const System& system, Host&) override { return std::make_unique<XpbdSession>(system, settings_); }

 private:
  Settings settings_;
};

}  // namespace

PECTORA_SOLVER(XpbdSolver, {.id = "solver.xpbd", .version = "1.0",
                            .summary = "Position-based dynamics with small steps: hard to upset, and as near the least energy as its steps are short",
                            .references = "Macklin, Mueller and Chentanez, MIG 2016; Macklin et al., Small steps in physics simulation, SCA 2019"})
