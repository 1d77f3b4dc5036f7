#include "plugins/solver/common/quasi_static.h"

#include "plugins/solver/common/movement.h"
#include "plugins/solver/common/newton.h"
#include "plugins/solver/common/secant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

// Between load steps it is enough to be near.
constexpr double kLooseTolerance = 1e-2;
constexpr double kLooseAccuracy = 0.1;   // of the step's way
constexpr double kLeastPartOfStep = 1.0 / 4;
// Single precision errs by less than a thousandth of this, mm, so that it is enough where such an accuracy is asked for.
constexpr double kRoughAccuracy = 0.01;
// A residual of this part of the largest force is right to a hundredth in single precision; a smaller one is taken in double.
constexpr double kRoughResidual = 1e-3;
// A step may end this far from its prediction, as a part of the bar's movement.
constexpr double kOffCourse = 0.5;

double largestDistance(const NodeVectors& a, const NodeVectors& b, std::size_t count) {
  double largest = 0;
  for (std::size_t i = 0; i < count; ++i) largest = std::max(largest, distance(a[i], b[i]));
  return largest;
}

class QuasiStatic final : public Session {
 public:
  QuasiStatic(const System& system, const QuasiStaticSettings& settings, std::unique_ptr<Minimiser> minimiser, int stepIterations,
              Acceleration acceleration)
      : system_(system), objective_(system), settings_(settings), minimiser_(std::move(minimiser)), stepIterations_(stepIterations), acceleration_(acceleration), isPredicted_(Newton::isFor(system)) {}

  void takeOver(Session& before) override {
    auto* other = dynamic_cast<QuasiStatic*>(&before);
    if (!other) return;
    secant_ = std::move(other->secant_);
    if (acceleration_.metric && other->acceleration_.metric) acceleration_.metric->takeOver(*other->acceleration_.metric);
  }

  Solution solve(const Drive& drive, const NodeVectors* start, Host& host) override {
    const int before = objective_.evaluations();
    objective_.setPrecision(acceleration_.accuracy >= kRoughAccuracy ? Precision::rough : Precision::full);
    Solution solution;
    follow(Movement(system_, drive, start), solution, host);
    if (start && solution.status != SolveStatus::converged) {
      host.info("the given start did not lead to rest; beginning from rest");
      follow(Movement(system_, drive, nullptr), solution, host);
    }
    if (objective_.precision() == Precision::rough && end_.relativeResidual() < kRoughResidual) {
      objective_.setPrecision(Precision::full);
      objective_.evaluate(solution.positions, end_);
    }
    if (!acceleration_.predictsFromStart && solution.status == SolveStatus::converged)
      secant_.remember(start ? *start : system_.rest, solution.positions, system_.freeNodes);
    solution.forceEvaluations = objective_.evaluations() - before;
    solution.residual = end_.residual.force;
    solution.relativeResidual = end_.relativeResidual();
    solution.energy = end_.energy;
    // Between solves these are but room.
    end_.gradient = {};
    if (!acceleration_.predictsFromStart) predictor_.reset();
    return solution;
  }

 private:
  // Steps along the movement. What the solution has counted before is kept.
  void follow(const Movement& movement, Solution& solution, Host& host) {
    solution.message.clear();
    NodeVectors& x = solution.positions;   // where the last step ended
    const int most = solution.iterations + settings_.maxIterations;
    const double way = movement.longestWay();
    const double wholeStep = 1 / std::max(1.0, std::ceil(way / (isPredicted_ ? settings_.loadStep : 0.1 * settings_.loadStep)));
    const double leastStep = wholeStep * kLeastPartOfStep;
    double t = 0, step = wholeStep;
    int halved = 0;
    for (;;) {
      const double next = t + 1.001 * step >= 1 ? 1 : t + step;
      const bool isLast = next == 1, isLeast = step < 2 * leastStep;
      const NodeVectors& from = t == 0 ? movement.beginning() : x;
      NodeVectors trial = from;
      movement.apply(next, trial);
      if (movement.isFromStart() && !acceleration_.predictsFromStart) {
        secant_.follow(from, trial, system_.freeNodes);
      } else if (isPredicted_) {
        if (!predictor_) predictor_ = std::make_unique<Newton>(system_, acceleration_.metric);
        predictor_->predict(objective_, from, trial, acceleration_.forcing, [&] { host.checkCancel(); });
      }
      // From a given start there is no path to keep to, so that the last step may end where it will.
      const NodeVectors predicted = movement.isFromStart() ? NodeVectors() : trial;
      const bool isFree = isLast && movement.isFromStart();
      const int left = most - solution.iterations;
      const double tolerance = isFree ? settings_.tolerance : std::max(settings_.tolerance, kLooseTolerance);
      const bool isLoose = !isLast && acceleration_.accuracy > 0;
      const double accuracy = isLoose ? std::max(acceleration_.accuracy, kLooseAccuracy * (next - t) * way) : acceleration_.accuracy;
      Outcome outcome = minimise(trial, {tolerance, isFree ? left : std::min(left, stepIterations_), accuracy}, next, solution, host);
      const bool isExhausted = solution.iterations >= most;
      const bool isNear = outcome == Outcome::converged || (outcome == Outcome::stalled && end_.isWithin(kLooseTolerance));
      const bool isOnCourse = isLeast || !isPredicted_ || movement.isFromStart() ||
                              largestDistance(trial, predicted, system_.freeNodes) <= kOffCourse * (next - t) * way;
      if ((isNear && isOnCourse) || isLeast || isExhausted) {
        x = std::move(trial);
        t = next;
        if (isLast && isNear && settings_.tolerance < tolerance && !isAccurate(outcome, tolerance))
          outcome = minimise(x, {settings_.tolerance, most - solution.iterations, acceleration_.accuracy}, 1, solution, host);
        solution.status = isLast ? statusOf(outcome) : SolveStatus::stalled;
        if (isLast || isExhausted || !isNear) break;
        step = std::min(wholeStep, 2 * step);
        continue;
      }
      step = 0.5 * step;
      ++halved;
    }
    if (halved > 0) host.info(fmt::format("{} load steps left their path or did not come to rest, and were halved", halved));
    if (solution.status == SolveStatus::converged) return;
    if (t < 1)
      solution.message = fmt::format("only {:.0f} % of the movement could be carried out; the largest force stays at the {}", 100 * t,
                                     system_.nodeName(end_.residual.node));
    else if (solution.iterations >= most)
      solution.message = fmt::format("{} iterations were not enough", settings_.maxIterations);
    else
      solution.message = "the energy falls no further; the largest force stays at the " + system_.nodeName(end_.residual.node);
  }

  Outcome minimise(NodeVectors& x, Minimiser::Limits limits, double part, Solution& solution, Host& host) {
    Watch watch;
    double before = INFINITY;   // the objective before the last step
    watch.poll = [&] { host.checkCancel(); };
    watch.iteration = [&](const Evaluation& now) {
      host.checkCancel();
      host.preview(x);
      solution.energyHistory.push_back(now.energy);
      if (before > 0) solution.energyGrowth = std::max(solution.energyGrowth, (now.value - before) / before);
      before = now.value;
      host.progress(progress(now.relativeResidual(), limits.tolerance) * part,
                    fmt::format("iteration {}, {:.0f} % of the way, residual {:.1e}", solution.iterations, 100 * part, now.relativeResidual()));
    };
    const int first = solution.iterations;
    const Outcome outcome = minimiser_->minimise(objective_, x, end_, limits, solution.iterations, watch);
    limits.iterations -= solution.iterations - first;
    if (outcome != Outcome::stalled || objective_.precision() == Precision::full || limits.iterations <= 0) return outcome;
    // Rounding may have hidden the way down.
    objective_.setPrecision(Precision::full);
    before = INFINITY;
    return minimiser_->minimise(objective_, x, end_, limits, solution.iterations, watch);
  }

  // Converged by nearness rather than by the residual: then that is what was asked for.
  bool isAccurate(Outcome outcome, double tolerance) const {
    return outcome == Outcome::converged && !end_.isWithin(tolerance);
  }
  // Decades of the residual from 1 to the tolerance.
  static double progress(double relative, double tolerance) {
    return std::clamp(std::log(std::max(relative, 1e-300)) / std::log(tolerance), 0.0, 1.0);
  }
  static SolveStatus statusOf(Outcome outcome) {
    return outcome == Outcome::converged ? SolveStatus::converged
           : outcome == Outcome::stalled ? SolveStatus::stalled : SolveStatus::diverged;
  }

  const System& system_;
  Objective objective_;
  Secant secant_;
  Evaluation end_;   // of the objective where the last minimisation ended
  QuasiStaticSettings settings_;
  std::unique_ptr<Minimiser> minimiser_;
  int stepIterations_;
  Acceleration acceleration_;
  bool isPredicted_;                    // every effect has a Hessian
  std::unique_ptr<Newton> predictor_;   // made when it is first needed
};

}  // namespace

void QuasiStaticSettings::describe(Visitor& v) {
  v.real("tolerance", tolerance, "", {1e-12, 0.5}, {1e-8, 1e-2}, "Stop when the largest force on a free point is this part of the largest spring force");
  v.integer("max_iterations", maxIterations, "", {1, 1e8}, {100, 10000}, "Stop unconverged after so many iterations in all");
  v.real("load_step", loadStep, "mm", {1e-3, 1e6}, {1, 50}, "How far the bar may move at once; a step that does not come to rest is halved");
}

std::unique_ptr<Session> makeQuasiStatic(const System& system, const QuasiStaticSettings& settings, std::unique_ptr<Minimiser> minimiser,
                                         int stepIterations, Acceleration acceleration) {
  return std::make_unique<QuasiStatic>(system, settings, std::move(minimiser), stepIterations, std::move(acceleration));
}

}  // namespace pectora
