#include "plugins/solver/projective/projective.h"

#include "plugins/solver/common/quasi_static.h"

namespace {
using namespace pectora;

constexpr int kStepIterations = 1000;

class ProjectiveSolver final : public Solver {
 public:
  ProjectiveSolver() { settings_.maxIterations = 10000; }
  void describe(Visitor& v) override {
    settings_.describe(v);
    v.integer("memory", memory_, "", {1, 100}, {3, 20}, "How many past steps accelerate the next");
  }
  Needs needs() const override { return {.springs = true}; }
  std::unique_ptr<Session> prepare(const System& system, Host&) override {
    return makeQuasiStatic(system, settings_, std::make_unique<Lbfgs>(makeProjectiveMetric(system), std::size_t(memory_)), kStepIterations);
  }

 private:
  QuasiStaticSettings settings_;
  int memory_ = 5;
};

}  // namespace

PECTORA_SOLVER(ProjectiveSolver, {.id = "solver.projective", .version = "1.0",
                                  .summary = "Local-global steps with one factored matrix, accelerated; for springs alone",
                                  .references = "Liu et al., SIGGRAPH Asia 2013; Liu, Bouaziz and Kavan, ACM TOG 2017"})
