// Energies of pairs of nodes that depend only on where one node is as seen from the other.
#pragma once

#include "kernel/physics/hessian.h"

#include <memory>
#include <string>
#include <vector>

namespace pectora {

/// What pair i does while its far node is at d from its near one.
class PairLaw {
 public:
  struct Pull {
    double energy = 0;      ///< N mm
    Vec3 force;             ///< on the near node, N; the far one feels the opposite
  };
  virtual ~PairLaw() = default;
  virtual Pull pull(std::size_t i, Vec3 d) const = 0;
  /// Second derivative of the energy by d, N/mm; `projected`: positive semi-definite.
  virtual Symmetric3 curvature(std::size_t i, Vec3 d, bool projected) const = 0;
  /// Bound of its stiffness, N/mm.
  virtual double stiffnessBound(std::size_t i) const = 0;
};

struct NodePair {
  std::size_t near = 0, far = 0;   ///< the near node is free
};

/// `holds`: as Term::holds. The system is needed for this call alone.
std::unique_ptr<Term> makePairTerm(std::string name, const System& system, std::vector<NodePair> pairs, std::unique_ptr<PairLaw> law, bool holds);

/// The law of a wall that pushes back: pair i feels k (gap)^2 / 2 while the near node is nearer than `clearance` to the far one,
/// measured along the unit vector `away`, which points from the far node to the near one's side.
struct Obstacle {
  Vec3 away;
  double clearance = 0, stiffnessNPerMm = 0;
};
std::unique_ptr<PairLaw> makeObstacleLaw(const std::vector<Obstacle>& obstacles);

}  // namespace pectora
