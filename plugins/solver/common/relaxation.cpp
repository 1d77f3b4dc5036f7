#include "plugins/solver/common/relaxation.h"

#include "plugins/solver/common/course.h"
#include "plugins/solver/common/movement.h"
#include "plugins/solver/common/node_algebra.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

// Growth of the energy between two looks at it that is more than the ripple of explicit steps. A wall that is distorted can be
// stiffer than its bound at rest; then steps are halved, so often at most.
constexpr double kGrowth = 0.05;
constexpr int kMostHalvings = 10;

constexpr double kMmPerM = 1000;  // N / kg is m/s^2

class Relaxation final : public Session {
 public:
  Relaxation(const System& system, RelaxationSettings settings, std::vector<double> mass, double step, double frequencyBound, MakeScheme make)
      : system_(system), settings_(settings), mass_(std::move(mass)), step_(step), frequencyBound_(frequencyBound), make_(std::move(make)) {}

  Solution solve(const Drive& drive, const NodeVectors* start, Host& host) override {
    const Movement movement(system_, drive, start);
    auto scheme = make_(system_, mass_, movement.beginning(), step_);
    Solution solution;
    double step = step_;
    int halvings = 0;
    double damping = settings_.damping, slowest = 0;
    double leastResidual = INFINITY;
    const double negligible = negligibleForce(system_);
    int leastAt = 0;
    double total = INFINITY;   // potential and kinetic energy when last looked at with the bar in place
    NodeVectors lastGood = scheme->positions();

    for (int n = 1; n <= settings_.maxIterations; ++n) {
      const double t = settings_.ramp > 0 ? std::min(1.0, double(n) / settings_.ramp) : 1;
      movement.apply(t, scheme->positions());
      const NodeVectors here = t >= 1 && n % 20 == 0 ? scheme->positions() : NodeVectors();
      scheme->step(damping);
      solution.iterations = n;

      // The best damping is critical for the slowest mode, which the motion itself shows.
      if (settings_.damping == 0) {
        const double seen = std::sqrt(scheme->rayleighQuotient());
        slowest = n < 10 ? seen : 0.95 * slowest + 0.05 * seen;
        damping = std::min(2 * slowest, 0.5 * frequencyBound_);
      }
      if (n % 20 != 0) continue;

      // Judge the forces of every twentieth state once the bar is in place.
      host.checkCancel();
      const Residual residual = largestResidual(system_, scheme->gradient());
      const double now = scheme->energy() + scheme->kineticEnergy();
      const bool isFinite = std::isfinite(residual.force) && std::isfinite(now);
      const bool grew = t >= 1 && total > 0 && total < INFINITY && !((now - total) / total <= kGrowth);
      if (grew && settings_.timeStep == 0 && halvings < kMostHalvings) {
        // Back to where it was last looked at, at rest there.
        solution.forceEvaluations += scheme->evaluations();
        step *= 0.5;
        ++halvings;
        scheme = make_(system_, mass_, lastGood, step);
        total = INFINITY;
        continue;
      }
      if (!isFinite) {
        solution.status = SolveStatus::diverged;
        solution.message = "a force at the " + system_.nodeName(residual.node) + " is not finite";
        break;
      }
      solution.energyHistory.push_back(scheme->energy());
      host.preview(scheme->positions());
      if (here.size() == 0) continue;
      lastGood = here;
      if (total > 0) solution.energyGrowth = std::max(solution.energyGrowth, (now - total) / total);
      total = now;
      record(solution, *scheme, residual);
      host.progress(progress(solution.relativeResidual), fmt::format("step {}, residual {:.1e}", n, solution.relativeResidual));
      if (residual.force <= settings_.tolerance * scheme->largestForce() || residual.force <= negligible) {
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
    if (halvings > 0) host.info(fmt::format("the wall is so distorted that steps were halved {} times", halvings));
    // Damped motion that is followed rightly only loses energy.
    if (solution.energyGrowth > kGrowth)
      solution.message += fmt::format("{}the energy grew by {:.0f} % between two looks at it: the time step is too long for a wall so distorted",
                                      solution.message.empty() ? "" : "; ", 100 * solution.energyGrowth);
    solution.positions = std::move(lastGood);
    solution.forceEvaluations += scheme->evaluations();
    return solution;
  }

 private:
  void record(Solution& solution, const ExplicitScheme& scheme, const Residual& residual) const {
    solution.residual = residual.force;
    solution.relativeResidual = scheme.largestForce() > 0 ? residual.force / scheme.largestForce() : 0;
    solution.energy = scheme.energy();
  }
  // Decades of the residual from 1 to the tolerance.
  double progress(double relative) const {
    return std::clamp(std::log(std::max(relative, 1e-300)) / std::log(settings_.tolerance), 0.0, 1.0);
  }

  const System& system_;
  RelaxationSettings settings_;
  std::vector<double> mass_;
  double step_, frequencyBound_;
  MakeScheme make_;
};

// An explicit scheme on its way in time.
class ExplicitTraveller final : public Traveller {
 public:
  ExplicitTraveller(std::unique_ptr<ExplicitScheme> scheme, double step, double damping) : scheme_(std::move(scheme)), step_(step), damping_(damping) {}
  Outcome step(const Guide& guide) override {
    scheme_->step(damping_);
    guide(double(++steps_) * step_, scheme_->positions());
    return Outcome::converged;
  }
  NodeVectors& positions() override { return scheme_->positions(); }
  NodeVectors velocity(const NodeVectors& gradient) const override { return scheme_->velocity(gradient, damping_); }
  int evaluations() const override { return scheme_->evaluations(); }

 private:
  std::unique_ptr<ExplicitScheme> scheme_;
  double step_, damping_;
  std::int64_t steps_ = 0;
};

class ExplicitCourse final : public Session {
 public:
  ExplicitCourse(const System& system, CourseSettings settings, MakeScheme make) : system_(system), settings_(settings), make_(std::move(make)) {}

  Solution solve(const Drive& drive, const NodeVectors* start, Host& host) override {
    return follow(system_, drive, start, settings_, [&](const NodeVectors& from, double step) {
      return std::make_unique<ExplicitTraveller>(make_(system_, system_.mass, from, step), step, system_.dynamics.damping);
    }, host);
  }

 private:
  const System& system_;
  CourseSettings settings_;
  MakeScheme make_;
};

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

ExplicitScheme::ExplicitScheme(const System& system, std::vector<double> mass, NodeVectors start, double step)
    : system_(system), mass_(std::move(mass)), step_(step), now_(std::move(start)), before_(now_),
      gradient_(system.rest.size()), gradientBefore_(system.rest.size()) {}

void ExplicitScheme::step(double damping) {
  std::swap(gradient_, gradientBefore_);
  energy_ = system_.evaluate(now_, gradient_, largestForce_);
  ++evaluations_;

  // Rayleigh quotient of the last displacement: dx . dg / dx . M dx.
  double change = 0, moved = 0;
  for (std::size_t i = 0; i < system_.freeNodes; ++i) {
    const Vec3 dx = now_[i] - before_[i];
    change += dot(dx, gradient_[i] - gradientBefore_[i]);
    moved += mass_[i] * dot(dx, dx);
  }
  kinetic_ = moved / (2 * step_ * step_ * kMmPerM);
  rayleigh_ = started_ && moved > 0 ? std::max(0.0, change / moved) * kMmPerM : 0;

  for (std::size_t i = 0; i < system_.freeNodes; ++i) {
    const Vec3 x = now_[i];
    now_.set(i, advance(x, before_[i], gradient_[i] * (-kMmPerM / mass_[i]), damping, !started_));
    before_.set(i, x);
  }
  started_ = true;
}

NodeVectors ExplicitScheme::velocity(const NodeVectors& gradient, double damping) const {
  NodeVectors velocity(system_.rest.size());
  if (!started_) return velocity;
  for (std::size_t i = 0; i < system_.freeNodes; ++i) {
    const Vec3 v = (now_[i] - before_[i]) / step_;
    velocity.set(i, v + (gradient[i] * (-kMmPerM / mass_[i]) - v * damping) * (step_ / 2));
  }
  return velocity;
}

void RelaxationSettings::describe(Visitor& v) {
  v.real("tolerance", tolerance, "", {1e-12, 0.5}, {1e-6, 1e-2}, "Stop when the largest force on a free point is this part of the largest spring force");
  v.integer("max_iterations", maxIterations, "", {1, 1e8}, {1000, 50000}, "Stop unconverged after so many steps");
  v.integer("ramp", ramp, "", {0, 1e7}, {0, 1000}, "Steps over which the bar is brought to its place; of a scene in time (effect.inertia) its own time counts, and so its damping and masses");
  v.real("time_step", timeStep, "s", {0, 10}, {0, 0.01}, "Step; refused beyond the stability limit; 0: nine tenths of it");
  v.real("damping", damping, "1/s", {0, 1e9}, {0, 1000}, "Velocity damping c in a = F/m - c v; 0: critical for the slowest mode seen");
  v.choice("mass", mass, {"scaled", "tissue"}, "Masses of the points: in proportion to their stiffness, which is fastest and gives the same end, or the tissue's own");
}

std::unique_ptr<Session> makeRelaxation(const System& system, const RelaxationSettings& settings, const std::string& scheme, MakeScheme make) {
  std::vector<double> mass = system.mass;
  const bool isInTime = system.dynamics.isAskedFor();
  if (settings.mass == "scaled" && !isInTime) {
    // The same frequency bound at every node, with the mean of the tissue's masses.
    const std::vector<double> stiffness = system.stiffnessBound();
    double stiffnessSum = 0, massSum = 0;
    for (std::size_t i = 0; i < system.freeNodes; ++i) stiffnessSum += stiffness[i], massSum += mass[i];
    for (std::size_t i = 0; i < system.freeNodes; ++i) mass[i] = massSum * stiffness[i] / stiffnessSum;
  }
  const double bound = std::sqrt(frequencyBoundSquared(system, mass));
  // With automatic damping the limit is that of the greatest damping it may choose.
  const double limit = stableStep(bound, isInTime ? system.dynamics.damping : settings.damping > 0 ? settings.damping : 0.5 * bound);
  if (settings.timeStep > limit)
    throw Error("the step is beyond the stability limit of " + scheme)
        .of("time_step").given(fmt::format("{:g} s", settings.timeStep)).allowed(fmt::format("up to {:.6g} s for this scene", limit)).advise("Leave it 0 for a safe step");
  const double step = settings.timeStep > 0 ? settings.timeStep : 0.9 * limit;
  if (isInTime) return std::make_unique<ExplicitCourse>(system, CourseSettings{step, settings.timeStep == 0, settings.maxIterations}, std::move(make));
  return std::make_unique<Relaxation>(system, settings, std::move(mass), step, bound, std::move(make));
}

}  // namespace pectora
