#include "plugins/solver/common/newton.h"
#include "plugins/solver/common/quasi_static.h"

namespace {
using namespace pectora;

// A load step that has not come to rest after so many Newton steps never does.
constexpr int kStepIterations = 60;

class NewtonSolver final : public Solver {
 public:
  void describe(Visitor& v) override { settings_.describe(v); }
  Needs needs() const override { return {.hessian = true}; }
  std::unique_ptr<Session> prepare(const System& system, Host&) override {
    return makeQuasiStatic(system, settings_, std::make_unique<Newton>(system), kStepIterations);
  }

 private:
  QuasiStaticSettings settings_;
};

}  // namespace

PECTORA_SOLVER(NewtonSolver, {.id = "solver.newton", .version = "1.0",
                              .summary = "Least energy by projected Newton steps with a line search; fast and hard to upset",
                              .references = "Nocedal and Wright, Numerical Optimization, 2006, ch. 7; Teran et al., SCA 2005, for the projection"})
