// How the driven nodes move while a solver works.
#pragma once

#include "kernel/physics/system.h"

namespace pectora {

/// Along the drive from rest, or straight from where an earlier motion left them to the drive's end. The arguments must
/// outlive it.
class Movement {
 public:
  /// `start` null: from rest.
  Movement(const System& system, const Drive& drive, const NodeVectors* start) : system_(system), drive_(drive), start_(start) {}

  bool isFromStart() const { return start_ != nullptr; }
  /// All nodes at the beginning.
  const NodeVectors& beginning() const { return start_ ? *start_ : system_.rest; }
  /// Writes the driven nodes' places after part t of the movement, 0 to 1.
  void apply(double t, NodeVectors& positions) const;
  /// The way of the node that goes farthest, mm.
  double longestWay() const;

 private:
  const System& system_;
  const Drive& drive_;
  const NodeVectors* start_;
};

}  // namespace pectora
