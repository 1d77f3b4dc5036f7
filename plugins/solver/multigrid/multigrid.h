// One multigrid cycle as the metric of minimisers: the first guess of the inverse Hessian is good over the whole wall at once, so
// that the number of iterations does not grow with the number of points.
#pragma once

#include "plugins/solver/common/metric.h"
#include "plugins/solver/common/objective.h"

namespace pectora {

/// The projected Hessian's inverse by one V-cycle. It is taken anew only where the old one has come to steer badly, so that
/// a small movement of the bar costs no preparation. The free nodes must be those of the layers' grid, and all terms must have
/// a Hessian; throws Error otherwise.
std::unique_ptr<Metric> makeMultigridMetric(const System& system);

/// L-BFGS that remembers `memory` steps, and Newton's method where that gets nowhere, both with this metric.
std::unique_ptr<Minimiser> makeMultigridMinimiser(const System& system, std::shared_ptr<Metric> metric, std::size_t memory);

}  // namespace pectora
