// Limited-memory BFGS (Nocedal and Wright, Numerical Optimization, algorithm 7.4) with a metric of one's own as the first
// guess of the inverse Hessian.
#pragma once

#include "plugins/solver/common/objective.h"

#include <deque>

namespace pectora {

/// A guess of the inverse Hessian.
class Metric {
 public:
  virtual ~Metric() = default;
  /// Fits it to a place; called when a minimisation begins.
  virtual void refresh(const NodeVectors& positions) = 0;
  /// d = M^-1 g for the free nodes. `d` has all nodes; the rest of it is not touched.
  virtual void apply(const NodeVectors& g, NodeVectors& d) const = 0;
};

/// The inverse 3 x 3 blocks of the projected Hessian's diagonal where all terms have one, else the inverse of the
/// stiffness bound. The system must outlive it.
std::unique_ptr<Metric> makeBlockJacobi(const System& system);

class Lbfgs final : public Minimiser {
 public:
  /// `memory`: how many steps it remembers.
  Lbfgs(std::unique_ptr<Metric> metric, std::size_t memory) : metric_(std::move(metric)), memory_(memory) {}
  Outcome minimise(const Objective& objective, NodeVectors& x, Evaluation& e, Limits limits, int& iterations, const Watch& watch) override;

 private:
  // One step remembered: s = change of place, y = change of gradient.
  struct Pair {
    NodeVectors s, y;
    double inverseSy;
  };
  void findDirection(const NodeVectors& gradient, std::size_t free);

  std::unique_ptr<Metric> metric_;
  std::size_t memory_;
  std::deque<Pair> pairs_;
  NodeVectors q_, direction_;
};

}  // namespace pectora
