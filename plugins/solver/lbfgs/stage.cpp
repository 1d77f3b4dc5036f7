#include "plugins/solver/common/lbfgs.h"
#include "plugins/solver/common/quasi_static.h"

namespace {
using namespace pectora;

constexpr int kStepIterations = 1000;

class LbfgsSolver final : public Solver {
 public:
  LbfgsSolver() { settings_.maxIterations = 10000; }
  void describe(Visitor& v) override {
    settings_.describe(v);
    v.integer("memory", memory_, "", {1, 100}, {3, 20}, "How many past steps shape the next");
  }
  std::unique_ptr<Session> prepare(const System& system, Host&) override {
    return makeQuasiStatic(system, settings_, std::make_unique<Lbfgs>(makeBlockJacobi(system), std::size_t(memory_)), kStepIterations);
  }

 private:
  QuasiStaticSettings settings_;
  int memory_ = 5;
};

}  // namespace

PECTORA_SOLVER(LbfgsSolver, {.id = "solver.lbfgs", .version = "1.0",
                             .summary = "Least energy by limited-memory BFGS; needs no more than gradients of the effects",
                             .references = "Nocedal and Wright, Numerical Optimization, 2006, algorithm 7.4"})
