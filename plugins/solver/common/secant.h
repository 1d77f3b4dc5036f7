// Where a wall will come to rest, from how it moved the last time: while a bar is dragged, one movement is much like the next.
#pragma once

#include "kernel/physics/system.h"

namespace pectora {

class Secant {
 public:
  /// The driven nodes went from where they are in `before` to where they are in `after`, and the free ones followed. A movement in which the
  /// driven nodes stood still is not remembered.
  void remember(const NodeVectors& before, const NodeVectors& after, std::size_t freeNodes);
  /// In `to` the driven nodes have moved on from `from`: moves the free ones as they did the last time, in proportion. Does nothing where
  /// the driven nodes go another way or much farther.
  void follow(const NodeVectors& from, NodeVectors& to, std::size_t freeNodes) const;

 private:
  SingleVectors change_;   // of all nodes; empty: none is known
};

}  // namespace pectora
