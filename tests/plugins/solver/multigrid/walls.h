// Fine walls, in which many points span the reach of the bar.
#pragma once

#include "plugins/solver/common/quasi_static.h"
#include "plugins/solver/multigrid/multigrid.h"

#include "kernel/physics/springs.h"
#include "tests/kernel/host/quiet_host.h"

#include <cmath>

namespace pectora {

// n x n points 2 mm apart and 20 mm thick, each pleura point with three anchors around it; without terms.
inline System fineGrid(int n) {
  System system;
  system.rows = system.columns = n;
  const std::size_t layer = system.points();
  system.freeNodes = 2 * layer;
  system.rest = NodeVectors(5 * layer);
  for (std::size_t i = 0; i < 5 * layer; ++i) {
    const std::size_t point = i % layer, anchor = i / layer;
    const double turn = 2.0 * M_PI / 3 * double(anchor);
    const Vec3 away = anchor < 2 ? Vec3{0, anchor == 0 ? -20.0 : 0.0, 0} : Vec3{8 * std::cos(turn), 4, 8 * std::sin(turn)};
    system.rest.set(i, Vec3{2.0 * double(point % n), 0, 2.0 * double(point / n)} + away);
  }
  system.mass.assign(system.freeNodes, 1e-4);
  return system;
}

// Gives it the paper's stencil, and ties every pleura point to its anchors. `reach`: of the oblique springs, in points; `skin`: stiffness of
// the springs within the skin, N/mm, where the others have 1.
inline void setTerms(System& system, int reach = 2, double skin = 1) {
  std::vector<StencilSpring> stencil;
  for (int r = -reach; r <= reach; ++r)
    for (int c = -reach; c <= reach; ++c) {
      stencil.push_back({Layer::outer, Layer::inner, r, c, 1});
      if (std::max(std::abs(r), std::abs(c)) <= 2 && (r > 0 || (r == 0 && c > 0))) stencil.push_back({Layer::outer, Layer::outer, r, c, skin});
    }
  std::vector<NodeSpring> ties;
  for (std::size_t anchor = 0; anchor < 3 * system.points(); ++anchor)
    ties.push_back({system.node(1, anchor % system.points()), system.anchorNode(anchor), 5});
  system.terms.clear();
  system.terms.push_back(makeLatticeTerm("lattice", system, stencil));
  system.terms.push_back(makeSpringTerm("ties", system, ties));
}

inline System fineWall(int n, int reach = 2, double skin = 1) {
  System system = fineGrid(n);
  setTerms(system, reach, skin);
  return system;
}

// The anchors in the middle go forwards, with a Gaussian of 12 mm.
inline Drive bump(const System& system, double height) {
  Drive drive;
  const double middle = system.columns - 1;
  for (const double part : {0.0, 1.0}) {
    std::vector<Vec3> frame;
    for (std::size_t i = system.freeNodes; i < system.rest.size(); ++i) {
      Vec3 p = system.rest[i];
      p.y -= part * height * std::exp(-(std::pow(p.x - middle, 2) + std::pow(p.z - middle, 2)) / (2 * 12 * 12));
      frame.push_back(p);
    }
    drive.frames.push_back(std::move(frame));
  }
  return drive;
}

// As the plugin makes it; `accuracy` in mm, 0: by the tolerance alone.
inline std::unique_ptr<Session> multigrid(const System& system, double tolerance, double accuracy = 0) {
  QuasiStaticSettings settings;
  settings.tolerance = tolerance;
  const std::shared_ptr<Metric> metric = makeMultigridMetric(system);
  return makeQuasiStatic(system, settings, makeMultigridMinimiser(system, metric, 5), 200, {.metric = metric, .forcing = 0.1, .predictsFromStart = false, .accuracy = accuracy});
}

}  // namespace pectora
