#include "plugins/solver/verlet/verlet.h"

namespace {
using namespace pectora;

class VerletSolver final : public Solver {
 public:
  void describe(Visitor& v) override { settings_.describe(v); }
  Needs needs() const override { return {.rest = false}; }
  std::unique_ptr<Session> prepare(const System& system, Host&) override {
    return makeRelaxation(system, settings_, "the Verlet scheme", [](const System& s, std::vector<double> mass, NodeVectors start, double step) {
      return std::make_unique<Verlet>(s, std::move(mass), std::move(start), step);
    });
  }

 private:
  RelaxationSettings settings_;
};

}  // namespace

PECTORA_SOLVER(VerletSolver, {.id = "solver.verlet", .version = "1.0",
                              .summary = "The paper's explicit Verlet integration, damped until the wall is at rest",
                              .references = "Moreira et al., SPIE 2012, eq. 1-3; Underwood 1983 for the damping"})
