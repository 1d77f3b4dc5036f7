// The part of a scene that an operation moves: points beyond it are left out of the unknowns.
#pragma once

#include "kernel/host/compile.h"
#include "kernel/stage/solver.h"

namespace pectora {

/// Rows [firstRow, endRow) and columns [firstColumn, endColumn) of a scene's layers.
struct Region {
  int firstRow = 0, endRow = 0, firstColumn = 0, endColumn = 0;
  bool operator==(const Region&) const = default;
  int points() const { return (endRow - firstRow) * (endColumn - firstColumn); }
};

/// The scene cut down to a region: its points with their masses, cells and anchors, and the same effects. `anchors` gets the scene's
/// index of each that stays.
std::shared_ptr<const Scene> crop(const Scene& scene, const Region& region, std::vector<std::size_t>& anchors);

/// Solves for the points that a movement of the bar takes farther than `still` mm, and those about them; the others stay at rest. The
/// region begins as the points whose anchors move so far, and one thickness of the wall around them. Its edge is free, so points there
/// go rather farther than they would in the whole wall: where one goes farther than `still`, that side is moved out by a thickness
/// and the solution goes on from there.
class RegionSolve {
 public:
  /// `whole`: the system of `scene`. All outlive it.
  RegionSolve(const Scene& scene, const System& whole, double still, Solver& solver, Registry& registry)
      : scene_(scene), whole_(whole), still_(still), solver_(solver), registry_(registry) {}
  /// As Session::solve for the whole system; `drive` is the plan's.
  Solution solve(const Plan& plan, const Drive& drive, const NodeVectors* start, Host& host);

 private:
  Region movedBy(const Drive& drive) const;
  Region wider(Region region, bool low, bool high, bool right, bool left) const;
  void prepare(const Region& region, Host& host);
  std::size_t wholeNode(std::size_t node) const;
  NodeVectors cut(const NodeVectors& positions, const Drive& drive) const;
  void paste(const NodeVectors& part, NodeVectors& positions) const;

  const Scene& scene_;
  const System& whole_;
  double still_;
  Solver& solver_;
  Registry& registry_;
  Region region_;
  std::vector<std::size_t> anchors_;          // the scene's, of the part's
  std::shared_ptr<const Scene> part_;         // null until there is a region
  Compiled compiled_;
  std::unique_ptr<Session> session_;
};

}  // namespace pectora
