#include "plugins/solver/common/objective.h"

#include <algorithm>
#include <cmath>

namespace pectora {

void Objective::evaluate(const NodeVectors& x, Evaluation& e) const {
  ++evaluations_;
  if (e.gradient.size() != x.size()) e.gradient = NodeVectors(x.size());
  e.energy = e.value = system_.evaluate(x, e.gradient, e.largestForce, precision_);
  if (inertia_) {
    for (std::size_t i = 0; i < system_.freeNodes; ++i) {
      const Vec3 away = x[i] - inertia_->target[i];
      e.value += 0.5 * inertia_->weight[i] * dot(away, away);
      e.gradient.add(i, away * inertia_->weight[i]);
    }
  }
  e.residual = largestResidual(system_, e.gradient);
  e.negligible = negligible_;
}

template <class D>
double searchLine(const Objective& objective, NodeVectors& x, Evaluation& e, const D& d, double firstStep, Trial& room) {
  auto& [trial, place] = room;
  const std::size_t count = objective.system().freeNodes;
  const double slope = dot(e.gradient, d, count);
  if (!(slope < 0)) return 0;
  const double rounding = (objective.precision() == Precision::full ? 1e-13 : 1e-6) * std::abs(e.value);
  double step = firstStep;
  for (int halving = 0; halving < 40; ++halving) {
    setSum(x, step, d, place, count);
    objective.evaluate(place, trial);
    const bool isFinite = std::isfinite(trial.value) && std::isfinite(trial.residual.force);
    const bool falls = trial.value <= e.value + 1e-4 * step * slope;
    const auto flattens = [&] { return trial.value <= e.value + rounding && std::abs(dot(trial.gradient, d, count)) <= 0.9 * -slope; };
    if (isFinite && (falls || flattens())) {
      std::swap(x, place);
      std::swap(e, trial);
      return step;
    }
    // The parabola through both values and the slope, within a tenth and a half of the step.
    const double parabola = -slope * step * step / (2 * (trial.value - e.value - slope * step));
    step = isFinite && std::isfinite(parabola) ? std::clamp(parabola, 0.1 * step, 0.5 * step) : 0.1 * step;
  }
  return 0;
}

template double searchLine(const Objective&, NodeVectors&, Evaluation&, const NodeVectors&, double, Trial&);
template double searchLine(const Objective&, NodeVectors&, Evaluation&, const SingleVectors&, double, Trial&);

}  // namespace pectora
