#include "plugins/solver/multigrid/multigrid.h"

#include "plugins/solver/multigrid/hierarchy.h"

#include "plugins/solver/common/lbfgs.h"
#include "plugins/solver/common/newton.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

namespace pectora {
namespace {

// A minimisation that took more cycles than this was steered badly.
constexpr int kManyCycles = 12;

class MultigridMetric final : public Metric {
 public:
  explicit MultigridMetric(const System& system) : system_(system), shape_(shapeOf(system)), hierarchy_(shape_) {
    if (!Newton::isFor(system)) throw Error("an effect has no second derivative").advise("Choose solver.lbfgs, which does without");
  }

  bool refresh(const NodeVectors& positions) override {
    const bool isGood = hierarchy_.isBuilt() && cycles_ <= kManyCycles;
    cycles_ = 0;
    if (isGood) return false;
    const std::unique_ptr<Hessian> hessian = makeHessian(system_);
    hessian->linearise(positions, true);
    hierarchy_.build(*hessian, system_.rest.size(), [&](const SingleVectors& in, SingleVectors& out) {
      out.clear();
      hessian->multiplySingle(in, out);
    });
    return true;
  }

  // Its coarse grids, until they steer badly.
  void takeOver(Metric& before) override {
    auto* other = dynamic_cast<MultigridMetric*>(&before);
    if (other && other->shape_ == shape_) hierarchy_ = std::move(other->hierarchy_);
  }

  void apply(const SingleVectors& g, SingleVectors& d) const override {
    ++cycles_;
    hierarchy_.cycle(g, d);
  }

 private:
  static GridShape shapeOf(const System& system) {
    if (system.freeNodes == 0 || system.freeNodes != system.anchorNode(0))
      throw Error(fmt::format("{} free points do not fill layers of {} x {} points", system.freeNodes, system.rows, system.columns))
          .advise("Choose another solver, such as solver.newton");
    return {system.layers, system.rows, system.columns};
  }

  const System& system_;
  GridShape shape_;
  mutable Hierarchy hierarchy_;
  mutable int cycles_ = 0;
};

// L-BFGS is fast while the wall changes little; where it gets nowhere, projected Newton steps do.
class MultigridMinimiser final : public Minimiser {
 public:
  MultigridMinimiser(const System& system, std::shared_ptr<Metric> metric, std::size_t memory)
      : system_(system), metric_(metric), fast_(std::move(metric), memory) {}

  Outcome minimise(const Objective& objective, NodeVectors& x, Evaluation& e, Limits limits, int& iterations, const Watch& watch) override {
    Limits first = limits;
    first.iterations = std::min(limits.iterations, kFastIterations);
    const int before = iterations;
    const Outcome outcome = fast_.minimise(objective, x, e, first, iterations, watch);
    limits.iterations -= iterations - before;
    if (outcome == Outcome::converged || limits.iterations <= 0) return outcome;
    if (!steady_) steady_ = std::make_unique<Newton>(system_);
    return steady_->minimise(objective, x, e, limits, iterations, watch);
  }

 private:
  static constexpr int kFastIterations = 150;

  const System& system_;
  std::shared_ptr<Metric> metric_;
  Lbfgs fast_;
  std::unique_ptr<Newton> steady_;
};

}  // namespace

std::unique_ptr<Minimiser> makeMultigridMinimiser(const System& system, std::shared_ptr<Metric> metric, std::size_t memory) {
  return std::make_unique<MultigridMinimiser>(system, std::move(metric), memory);
}

std::unique_ptr<Metric> makeMultigridMetric(const System& system) { return std::make_unique<MultigridMetric>(system); }

}  // namespace pectora
