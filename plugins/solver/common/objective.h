// What a minimiser makes small: the system's energy, and for a step in time its inertia as well.
#pragma once

#include "plugins/solver/common/node_algebra.h"

namespace pectora {

/// A pull of every free node towards a place: 1/2 w_i |x_i - y_i|^2, with w in N/mm.
struct Inertia {
  std::vector<double> weight;
  NodeVectors target;
};

/// The objective at one place.
struct Evaluation {
  double value = 0;             ///< energy and inertia, N mm
  double energy = 0;            ///< N mm
  double largestForce = 0;      ///< of a single spring, N
  Residual residual;            ///< of the objective's gradient
  double negligible = 0;        ///< force that counts as none, N
  NodeVectors gradient;         ///< N; of driven nodes it means nothing

  double relativeResidual() const { return largestForce > 0 ? residual.force / largestForce : 0; }
  /// Meaning of `tolerance` in all solvers: the largest free force over the largest spring force.
  bool isWithin(double tolerance) const { return residual.force <= tolerance * largestForce || residual.force <= negligible; }
};

class Objective {
 public:
  explicit Objective(const System& system) : system_(system), negligible_(negligibleForce(system)) {}

  const System& system() const { return system_; }
  /// Null: no inertia. Must stay alive.
  void setInertia(const Inertia* inertia) { inertia_ = inertia; }
  const Inertia* inertia() const { return inertia_; }
  /// What evaluations are worth from now on; full at first.
  void setPrecision(Precision precision) { precision_ = precision; }
  Precision precision() const { return precision_; }
  void evaluate(const NodeVectors& x, Evaluation& e) const;
  /// How often it was evaluated.
  int evaluations() const { return evaluations_; }

 private:
  const System& system_;
  double negligible_;
  const Inertia* inertia_ = nullptr;
  Precision precision_ = Precision::full;
  mutable int evaluations_ = 0;
};

/// What became of one minimisation.
enum class Outcome { converged, stalled, diverged };

/// Who looks on. Both may throw to stop the work.
struct Watch {
  std::function<void(const Evaluation& now)> iteration = [](const Evaluation&) {};   ///< before every iteration
  std::function<void()> poll = [] {};                                              ///< now and then within a long one
};

/// Finds the nearest minimum of an objective.
class Minimiser {
 public:
  virtual ~Minimiser() = default;
  struct Limits {
    double tolerance = 1e-4;
    int iterations = 100;
    double accuracy = 0;   ///< mm; if above 0, being about so near the minimum will do as well
  };
  /// `x` is where to begin and becomes the end, which is always finite and no higher than the beginning; `e` is the
  /// objective there. `iterations` is raised.
  virtual Outcome minimise(const Objective& objective, NodeVectors& x, Evaluation& e, Limits limits, int& iterations, const Watch& watch) = 0;
};

/// Room for what is tried; `place` holds the driven nodes where they are.
struct Trial {
  explicit Trial(const NodeVectors& x) : place(x) {}
  Evaluation evaluation;
  NodeVectors place;
};

/// Goes from x along d until the objective has fallen (Armijo, 1e-4), halving the step at need. Where rounding hides the
/// fall, a slope that has become flatter will do (Hager and Zhang 2005). `x` and `e` move to the new place,
/// and the old ones are left in `trial`. Returns the step, 0 if there was none. D is NodeVectors or SingleVectors.
template <class D>
double searchLine(const Objective& objective, NodeVectors& x, Evaluation& e, const D& d, double firstStep, Trial& trial);

}  // namespace pectora
