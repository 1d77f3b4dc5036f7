#include "plugins/solver/semi_implicit/semi_implicit.h"

namespace {
using namespace pectora;

class SemiImplicitEulerSolver final : public Solver {
 public:
  void describe(Visitor& v) override { settings_.describe(v); }
  Needs needs() const override { return {.rest = false}; }
  std::unique_ptr<Session> prepare(const System& system, Host&) override {
    return makeRelaxation(system, settings_, "semi-implicit Euler", [](const System& s, std::vector<double> mass, NodeVectors start, double step) {
      return std::make_unique<SemiImplicitEuler>(s, std::move(mass), std::move(start), step);
    });
  }

 private:
  RelaxationSettings settings_;
};

}  // namespace

PECTORA_SOLVER(SemiImplicitEulerSolver, {.id = "solver.semi_implicit", .version = "1.0",
                                         .summary = "Symplectic Euler in time, damped until the wall is at rest; of order 1",
                                         .references = "Hairer, Lubich and Wanner, Geometric Numerical Integration, 2006, I.1; Underwood 1983 for the damping"})
