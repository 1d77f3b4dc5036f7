// What accuracy costs in time, for one scene.
#pragma once

#include "app/view/session/choices.h"

#include "kernel/host/runner.h"
#include "kernel/value/motion.h"
#include "kernel/value/plan.h"

#include <functional>

namespace pectora::view {

/// One solve from rest.
struct StudyPoint {
  std::string solver;             ///< "solver.newton"
  double tolerance = 0;
  double milliseconds = 0;        ///< wall time, from a compiled scene
  double rms = 0;                 ///< distance of the skin from the reference's over the pit, mm
  SolveStatus status = SolveStatus::converged;
  bool isPresent = false;         ///< the run that the window shows
};

struct Study {
  std::string reference;          ///< how the skin was found that errors are measured from
  std::vector<StudyPoint> points;
  std::vector<std::pair<std::string, std::string>> refused;   ///< solvers that cannot solve this scene, and why
};

/// Solves the scene with several solvers at several tolerances and with the present one, and measures them against newton's skin (or
/// lbfgs's, where effects have no Hessian) at a tolerance of 1e-8. The pit is what that moves by more than 3 mm, or the whole skin if
/// nothing does. Throws Error if the reference does not come to rest, and Cancelled.
Study studyScene(const std::shared_ptr<const Scene>& scene, const Plan& plan, const PluginChoice& present, Registry& registry,
                 const std::atomic<bool>& cancel, const std::function<void(double, const std::string&)>& progress);

}  // namespace pectora::view
