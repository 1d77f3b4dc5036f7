// The weight of every free point: a force that never changes.
#pragma once

#include "kernel/physics/system.h"

namespace pectora {

/// Energy -sum m_i g . x_i in N mm, from the rest positions on. `acceleration` in m/s^2; masses are the system's.
std::unique_ptr<Term> makeWeightTerm(const System& system, Vec3 acceleration);

}  // namespace pectora
