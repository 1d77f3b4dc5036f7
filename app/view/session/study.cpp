#include "app/view/session/study.h"

#include "app/view/session/live.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace pectora::view {
namespace {

constexpr double kTolerances[] = {1e-2, 1e-3, 1e-4, 1e-6};
constexpr double kReferenceTolerance = 1e-8, kPit = 3;   // mm
constexpr double kPatience = 4000;                       // ms: a solver that took longer is not asked for a finer answer

// Distance over the points that the reference moves by more than kPit, or over all.
double rmsInPit(const Motion& motion, const Motion& reference) {
  double sum = 0, sumAll = 0;
  std::size_t count = 0;
  const std::vector<Vec3>& rest = reference.scene->outer;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const double d = distance(motion.outer[i], reference.outer[i]);
    sumAll += d * d;
    if (distance(rest[i], reference.outer[i]) > kPit) sum += d * d, ++count;
  }
  return count > 0 ? std::sqrt(sum / double(count)) : std::sqrt(sumAll / double(rest.size()));
}

}  // namespace

Study studyScene(const std::shared_ptr<const Scene>& scene, const Plan& plan, const PluginChoice& present, Registry& registry,
                 const std::atomic<bool>& cancel, const std::function<void(double, const std::string&)>& progress) {
  // Nobody is shown these skins, nor the same messages again and again.
  Messages silent;
  double milliseconds = 0;
  const auto solve = [&](const PluginChoice& solver) {
    LiveHost host(solver.id, silent, cancel);
    WarmSolve cold(scene, solver.id, makeSolver(registry, solver), registry, host);
    const auto start = std::chrono::steady_clock::now();
    auto motion = cold.solve(plan, host);
    milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return motion;
  };

  // The reference.
  Study study;
  std::shared_ptr<const Motion> reference;
  for (const char* id : {"solver.newton", "solver.lbfgs"}) {
    progress(0, std::string("reference by ") + id);
    try {
      reference = solve({id, {{"tolerance", kReferenceTolerance}}});
      study.reference = fmt::format("{} to {:.0e}", id, kReferenceTolerance);
      if (reference->status == SolveStatus::converged) break;
    } catch (const Error& error) {
      if (std::string(id) == "solver.lbfgs") throw;
    }
  }
  if (reference->status != SolveStatus::converged)
    throw Error("there is no reference to study this scene against: it does not come to rest at a tolerance of 1e-8", ErrorKind::runFailed)
        .advise("Lower the lift, or leave out the effect that was added last");

  const auto add = [&](const PluginChoice& solver, double tolerance, bool isPresent) {
    const auto motion = solve(solver);
    study.points.push_back({solver.id, tolerance, milliseconds, rmsInPit(*motion, *reference), motion->status, isPresent});
  };
  const std::vector<std::string> solvers{"solver.verlet", "solver.newton", "solver.lbfgs", "solver.multigrid"};
  for (std::size_t s = 0; s < solvers.size(); ++s) {
    milliseconds = 0;
    for (double tolerance : kTolerances) {
      if (milliseconds > kPatience) break;
      progress(double(s + 1) / double(solvers.size() + 2), fmt::format("{} to {:.0e}", solvers[s], tolerance));
      try {
        add({solvers[s], {{"tolerance", tolerance}}}, tolerance, false);
      } catch (const Error& error) {
        study.refused.emplace_back(solvers[s], error.what());
        break;
      }
    }
  }
  // The run that is shown.
  progress(0.95, present.id);
  double tolerance = 0;
  const auto solver = makeSolver(registry, present);
  for (const Parameter& p : parameters([&](Visitor& v) { solver->describe(v); }))
    if (p.name == "tolerance") tolerance = std::get<double>(p.value);
  add(present, tolerance, true);
  return study;
}

}  // namespace pectora::view
