// Springs between nodes, and springs that repeat over the grid of skin and pleura. Energy of one: 1/2 k (l - l0)^2.
#pragma once

#include "kernel/physics/system.h"

namespace pectora {

/// The skin and the pleura: the first and the last layer of a system.
enum class Layer { outer, inner };

/// A spring from every point (r, c) of layer `from` to (r + rows, c + columns) of layer `to`, where that exists.
/// Between points of one layer give each pair once. Its rest length is the distance at rest.
struct StencilSpring {
  Layer from = Layer::outer, to = Layer::outer;
  int rows = 0, columns = 0;
  double stiffnessNPerMm = 0;
  double compression = 1;   ///< part of the stiffness that acts while it is shorter than at rest: 1 a spring, 0 a thread
};

/// A spring between two nodes by number.
struct NodeSpring {
  std::size_t a = 0, b = 0;
  double stiffnessNPerMm = 0;
};

/// All stencils of a scene in one term: a single pass over the points evaluates every kind of spring that was called.
/// A spring of zero length takes the direction it had at rest.
std::unique_ptr<Term> makeLatticeTerm(std::string name, const System& system, std::vector<StencilSpring> stencil);

/// Springs by list, such as the attachments.
std::unique_ptr<Term> makeSpringTerm(std::string name, const System& system, std::vector<NodeSpring> springs);

}  // namespace pectora
