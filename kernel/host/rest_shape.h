// The shape of the chest without the loads that the CT shows it under.
#pragma once

#include "kernel/host/compile.h"
#include "kernel/stage/host.h"
#include "kernel/stage/solver.h"

namespace pectora {

/// The scene whose points, under those loads, come to rest where `scene` has them. Found by going back by what the loads move
/// (Sellier, Finite Elements in Analysis and Design 2011); anchors that a point sits on go with it. Null if there is none near:
/// a wall that is soft beside its load snaps over instead.
std::shared_ptr<const Scene> findRestShape(const Scene& scene, Solver& solver, Registry& registry, Host& host);

}  // namespace pectora
