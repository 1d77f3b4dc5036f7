#include "plugins/solver/multigrid/multigrid.h"

#include "plugins/solver/common/quasi_static.h"

namespace {
using namespace pectora;

constexpr int kStepIterations = 200;
// The linear answer need not be better than the bar's movement is linear.
constexpr double kForcing = 0.1;

class MultigridSolver final : public Solver {
 public:
  MultigridSolver() { settings_.maxIterations = 2000; }
  void describe(Visitor& v) override {
    settings_.describe(v);
    v.real("accuracy", accuracy_, "mm", {0, 100}, {0, 1}, "Stop as soon as no point is estimated to be farther than this from rest; 0: by the tolerance alone");
    v.integer("memory", memory_, "", {1, 100}, {3, 20}, "How many past steps shape the next");
  }
  Needs needs() const override { return {.hessian = true}; }
  std::unique_ptr<Session> prepare(const System& system, Host&) override {
    const std::shared_ptr<Metric> metric = makeMultigridMetric(system);
    return makeQuasiStatic(system, settings_, makeMultigridMinimiser(system, metric, std::size_t(memory_)), kStepIterations,
                           {.metric = metric, .forcing = kForcing, .predictsFromStart = false, .accuracy = accuracy_});
  }

 private:
  QuasiStaticSettings settings_;
  double accuracy_ = 0;
  int memory_ = 5;
};

}  // namespace

PECTORA_SOLVER(MultigridSolver, {.id = "solver.multigrid", .version = "1.0",
                                 .summary = "Least energy by L-BFGS with a multigrid cycle as its metric; the fast one",
                                 .references = "Briggs, Henson and McCormick, A Multigrid Tutorial, 2000; Nocedal and Wright, Numerical Optimization, 2006"})
