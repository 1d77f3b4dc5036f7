#include "plugins/solver/implicit/implicit.h"

#include "plugins/solver/common/course.h"
#include "plugins/solver/common/movement.h"

#include "kernel/stage/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace {
using namespace pectora;

struct Settings {
  double tolerance = 1e-6, timeStep = 0.02, ramp = 0.2, damping = 0;
  int maxIterations = 2000;
  std::string scheme = "euler";
};

ImplicitScheme schemeOf(const Settings& settings) { return settings.scheme == "bdf2" ? ImplicitScheme::bdf2 : ImplicitScheme::backwardEuler; }

// A tenth of the tolerance within a step leaves the rest of it to the motion.
Minimiser::Limits stepLimits(const Settings& settings) { return {0.1 * settings.tolerance, 100}; }

class ImplicitSession final : public Session {
 public:
  ImplicitSession(const System& system, const Settings& settings) : system_(system), settings_(settings) {}

  Solution solve(const Drive& drive, const NodeVectors* start, Host& host) override {
    const Movement movement(system_, drive, start);
    ImplicitStepper stepper(system_, system_.mass, movement.beginning(), settings_.timeStep, settings_.damping, schemeOf(settings_));
    Solution solution;
    Watch watch;
    watch.poll = [&] { host.checkCancel(); };
    double before = INFINITY;   // the step's objective before the last iteration
    watch.iteration = [&](const Evaluation& e) {
      host.checkCancel();
      if (before > 0) solution.energyGrowth = std::max(solution.energyGrowth, (e.value - before) / before);
      before = e.value;
    };
    const int rampSteps = int(std::ceil(settings_.ramp / settings_.timeStep));
    for (int n = 1; n <= settings_.maxIterations; ++n) {
      const double t = n < rampSteps ? double(n) / rampSteps : 1;
      movement.apply(t, stepper.positions());
      before = INFINITY;
      const Outcome outcome = stepper.step(stepLimits(settings_), watch);
      const Evaluation& e = stepper.evaluateRest();
      solution.iterations = n;
      solution.energyHistory.push_back(e.energy);
      solution.energy = e.energy;
      solution.residual = e.residual.force;
      solution.relativeResidual = e.relativeResidual();
      if (outcome == Outcome::diverged) {
        solution.status = SolveStatus::diverged;
        solution.message = "a force at the " + system_.nodeName(e.residual.node) + " is not finite";
        break;
      }
      host.preview(stepper.positions());
      host.progress(t * std::clamp(std::log(std::max(solution.relativeResidual, 1e-300)) / std::log(settings_.tolerance), 0.0, 1.0),
                    fmt::format("step {}, residual {:.1e}", n, solution.relativeResidual));
      if (t < 1 || !e.isWithin(settings_.tolerance)) {
        solution.message = fmt::format("{} steps were not enough; the largest force stays at the {}", n, system_.nodeName(e.residual.node));
        continue;
      }
      solution.status = SolveStatus::converged;
      solution.message.clear();
      break;
    }
    solution.positions = stepper.positions();
    solution.forceEvaluations = stepper.evaluations();
    return solution;
  }

 private:
  const System& system_;
  Settings settings_;
};

class ImplicitTraveller final : public Traveller {
 public:
  ImplicitTraveller(const System& system, NodeVectors start, double step, const Settings& settings, Host& host)
      : step_(step), settings_(settings), stepper_(system, system.mass, std::move(start), step, system.dynamics.damping, schemeOf(settings)) {
    watch_.poll = [&host] { host.checkCancel(); };
  }
  Outcome step(const Guide& guide) override {
    guide(double(++steps_) * step_, stepper_.positions());
    return stepper_.step(stepLimits(settings_), watch_);
  }
  NodeVectors& positions() override { return stepper_.positions(); }
  NodeVectors velocity(const NodeVectors&) const override { return stepper_.velocity(); }
  int evaluations() const override { return stepper_.evaluations(); }

 private:
  double step_;
  Settings settings_;
  ImplicitStepper stepper_;
  Watch watch_;
  std::int64_t steps_ = 0;
};

class ImplicitCourse final : public Session {
 public:
  ImplicitCourse(const System& system, const Settings& settings) : system_(system), settings_(settings) {}
  Solution solve(const Drive& drive, const NodeVectors* start, Host& host) override {
    return follow(system_, drive, start, {settings_.timeStep, false, settings_.maxIterations}, [&](const NodeVectors& from, double step) {
      return std::make_unique<ImplicitTraveller>(system_, from, step, settings_, host);
    }, host);
  }

 private:
  const System& system_;
  Settings settings_;
};

class ImplicitSolver final : public Solver {
 public:
  void describe(Visitor& v) override {
    v.real("tolerance", settings_.tolerance, "", {1e-12, 0.5}, {1e-8, 1e-2}, "Stop when the largest force on a free point is this part of the largest spring force");
    v.integer("max_iterations", settings_.maxIterations, "", {1, 1e8}, {100, 10000}, "Stop unconverged after so many steps in time");
    v.choice("scheme", settings_.scheme, {"euler", "bdf2"}, "Backward Euler, of order 1 and strongly damped, or BDF2, of order 2");
    v.real("time_step", settings_.timeStep, "s", {1e-9, 1e3}, {0.001, 0.1}, "Step; any is stable");
    v.real("ramp", settings_.ramp, "s", {0, 1e6}, {0, 2}, "Time over which the bar is brought to its place; of a scene in time (effect.inertia) its own counts, and so its damping");
    v.real("damping", settings_.damping, "1/s", {0, 1e9}, {0, 1000}, "Velocity damping c in a = F/m - c v, beside that of the scheme");
  }
  Needs needs() const override { return {.hessian = true, .rest = false}; }
  std::unique_ptr<Session> prepare(const System& system, Host&) override {
    if (system.dynamics.isAskedFor()) return std::make_unique<ImplicitCourse>(system, settings_);
    return std::make_unique<ImplicitSession>(system, settings_);
  }

 private:
  Settings settings_;
};

}  // namespace

PECTORA_SOLVER(ImplicitSolver, {.id = "solver.implicit", .version = "1.0",
                                .summary = "Implicit steps in time until rest, by backward Euler or BDF2; stable with any step",
                                .references = "Baraff and Witkin, SIGGRAPH 1998; Hairer and Wanner, Solving ODEs II, 1996, V.1"})
