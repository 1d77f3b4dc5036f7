// Local-global (projective) steps: the local one turns each spring to its rest length, p = l0 d / |d|; the global one solves
// L x = J p with L = sum k (e_a - e_b)(e_a - e_b)^T, which never changes. One such step is x - L^-1 grad E (Liu, Bouaziz and
// Kavan 2017), so that L serves as the metric of L-BFGS, which accelerates it.
#pragma once

#include "plugins/solver/common/lbfgs.h"

namespace pectora {

/// L of the free nodes, factored once. All terms must be springs. Throws Error if L is singular: then some free nodes hang
/// together but on nothing that is driven.
std::unique_ptr<Metric> makeProjectiveMetric(const System& system);

}  // namespace pectora
