// A scene that is followed in time (System::dynamics): the wall goes from rest while the bar is brought to its place, and swings on.
#pragma once

#include "plugins/solver/common/objective.h"

#include "kernel/stage/solver.h"

#include <memory>

namespace pectora {

/// Brings the driven nodes of `positions` to where they are at a time, s.
using Guide = std::function<void(double time, NodeVectors& positions)>;

/// A system on its way in time, by steps of one length.
class Traveller {
 public:
  virtual ~Traveller() = default;
  /// Goes one step on, to the guided places of driven nodes at its end. Diverged: it could not, and stays where it was; stalled: it did
  /// not reach its own tolerance.
  virtual Outcome step(const Guide& guide) = 0;
  virtual NodeVectors& positions() = 0;
  /// Velocity of the free nodes at these positions, mm/s; `gradient` is that of the energy there, N.
  virtual NodeVectors velocity(const NodeVectors& gradient) const = 0;
  /// Force evaluations so far.
  virtual int evaluations() const = 0;
};

/// A traveller at rest at `start` at time 0, with the system's masses and damping, and steps of this length, s.
using MakeTraveller = std::function<std::unique_ptr<Traveller>(const NodeVectors& start, double step)>;

struct CourseSettings {
  double longestStep = 0;   ///< s
  bool mayHalve = false;    ///< whether steps are halved, and all begun anew, when the energy grows
  int mostSteps = 0;        ///< refused beyond
};

/// Follows the system to the end of its dynamics' duration, with its driven nodes on `drive`, softly: the part 3 s^2 - 2 s^3 after the part
/// s of the time of lifting. Steps are the longest whose multiple the interval is. Potential and kinetic energy together may only fall
/// once the driven nodes are in place, up to a ripple of 5 %; where they grow by more, or a force is no longer finite, the motion
/// has diverged and ends with the last moment that was sound. Throws Error if the steps are too many.
Solution follow(const System& system, const Drive& drive, const NodeVectors* start, CourseSettings settings, const MakeTraveller& make, Host& host);

}  // namespace pectora
