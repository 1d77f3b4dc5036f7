// The interface of a solver plugin: it finds where the free nodes go when the driven ones move.
#pragma once

#include "kernel/physics/system.h"
#include "kernel/stage/plugin.h"
#include "kernel/value/motion.h"

namespace pectora {

/// Positions with the account of how they were found. `positions` are always finite.
struct Solution {
  NodeVectors positions;
  SolveStatus status = SolveStatus::stalled;
  std::string message;                 ///< what is wrong, and where, if not converged
  int iterations = 0;
  int forceEvaluations = 0;
  double residual = 0;                 ///< largest force on a free node, N
  double relativeResidual = 0;
  double energy = 0;                   ///< N mm
  std::vector<double> energyHistory;   ///< N mm
  double energyGrowth = 0;             ///< largest rise of what the method lets only fall (a minimiser its objective, an integrator
                                       ///< potential and kinetic energy) with the driven nodes at rest, over its value before
  std::vector<Moment> moments;         ///< of a scene that asks for them (System::dynamics), from rest to the end
};

/// A prepared system. solve can be called again and again.
class Session {
 public:
  virtual ~Session() = default;
  /// Solves for the whole motion of `drive`. `start` (all nodes, the driven ones where an earlier motion left them) is where
  /// to begin, and the driven nodes then go straight to the end of `drive`; null: at rest.
  /// Throws Cancelled when the host says so.
  virtual Solution solve(const Drive& drive, const NodeVectors* start, Host& host) = 0;
  /// Takes from `before`, a session of the same plugin for a system that was a little different, what it prepared at length and what still
  /// does here: guesses that steer, nothing that decides the answer. `before` is not asked again.
  virtual void takeOver(Session& /*before*/) {}
};

/// What a solver uses of every term beside energy and gradient, which all terms have; and what it cannot do without.
struct Needs {
  bool hessian = false;   ///< Term::makeHessian
  bool springs = false;   ///< Term::forEachSpring: the term is nothing but springs
  bool rest = true;       ///< that rest is all that is asked for: it does not follow motions in time (System::dynamics)
};

class Solver {
 public:
  virtual ~Solver() = default;
  virtual void describe(Visitor& visitor) = 0;
  /// An effect that cannot give it is refused by name before any work.
  virtual Needs needs() const { return {}; }
  /// Checks the settings against the system and prepares it. The system outlives the session.
  /// Throws Error if a setting cannot work for this system.
  virtual std::unique_ptr<Session> prepare(const System& system, Host& host) = 0;
};

}  // namespace pectora
