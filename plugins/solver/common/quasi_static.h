// What the solvers that look for rest without time have in common: the load is brought on in steps, and each step is
// minimised from the end of the last.
#pragma once

#include "plugins/solver/common/metric.h"
#include "plugins/solver/common/objective.h"

#include "kernel/stage/solver.h"

namespace pectora {

struct QuasiStaticSettings {
  double tolerance = 1e-6, loadStep = 10;
  int maxIterations = 1000;
  void describe(Visitor& v);
};

/// What makes it faster.
struct Acceleration {
  std::shared_ptr<Metric> metric;   ///< for the linear answer
  double forcing = 1e-2;            ///< the error of the linear answer, as a part of it
  bool predictsFromStart = true;    ///< also from a given start, where no path is judged by it: false if a step of the minimiser costs less; then
                                    ///< the wall goes on as it did the last time
  double accuracy = 0;              ///< see Minimiser::Limits
};

/// A session around a minimiser. Every load step begins at the linear answer to the bar's movement, and one that comes to
/// rest elsewhere, or nowhere, is halved, to 1/4 at the least: so that the wall keeps to its path from rest where it can. If
/// a given start does not lead to rest, it begins again from rest. `stepIterations` is what one load step may take. Where an
/// effect has no Hessian there is no linear answer: the steps are a tenth as long.
std::unique_ptr<Session> makeQuasiStatic(const System& system, const QuasiStaticSettings& settings, std::unique_ptr<Minimiser> minimiser,
                                         int stepIterations, Acceleration acceleration = {});

}  // namespace pectora
