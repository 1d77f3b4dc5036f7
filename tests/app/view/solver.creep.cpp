// For tests of the window: from rest it is done at once; from anywhere else it brings the wall forward step by step and never arrives.
#include "kernel/stage/solver.h"

#include <chrono>
#include <thread>

namespace {
using namespace pectora;

class Creeping final : public Session {
 public:
  explicit Creeping(const System& system) : system_(system) {}
  Solution solve(const Drive& drive, const NodeVectors* start, Host& host) override {
    Solution solution;
    solution.status = SolveStatus::converged;
    solution.positions = start ? *start : system_.rest;
    drive.apply(1, system_.freeNodes, solution.positions);
    if (!start) return solution;
    host.info("begins");
    for (;;) {
      host.checkCancel();
      host.info("steps");
      std::this_thread::sleep_for(std::chrono::milliseconds(40));
      for (std::size_t i = 0; i < system_.freeNodes; ++i) solution.positions.set(i, solution.positions[i] - Vec3{0, 1, 0});
      host.preview(solution.positions);
    }
  }

 private:
  const System& system_;
};

class Creep final : public Solver {
 public:
  void describe(Visitor&) override {}
  std::unique_ptr<Session> prepare(const System& system, Host&) override { return std::make_unique<Creeping>(system); }
};

}  // namespace

PECTORA_SOLVER(Creep, {.id = "solver.creep", .version = "1.0", .summary = "Never arrives"})
