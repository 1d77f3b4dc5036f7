// A scene made ready for a solver once, and solved for one plan after another.
#pragma once

#include "kernel/host/region.h"
#include "kernel/stage/solver.h"
#include "kernel/value/motion.h"

namespace pectora {

/// What a slider needs: the scene is compiled and the solver prepared once, and each solve begins where the last one ended.
/// Where the wall can settle in more than one way, its end depends on where it began.
class WarmSolve {
 public:
  /// Compiles the scene. `id` names the solver in messages. Throws Error if the scene makes no problem, or an effect cannot
  /// give what the solver uses.
  WarmSolve(std::shared_ptr<const Scene> scene, std::string id, std::unique_ptr<Solver> solver, Registry& registry, Host& host);

  const std::shared_ptr<const Scene>& scene() const { return scene_; }
  const Compiled& compiled() const { return compiled_; }
  /// The next solve begins where `motion` ended: of this scene, or of one with the same points and anchors. Throws Error for
  /// another scene's.
  void startFrom(const Motion& motion);
  /// The same for positions of all nodes, such as a solver shows on its way (Host::preview). Empty: at rest.
  void startFrom(NodeVectors positions);
  /// Takes from the solve of a scene that was a little different, such as before a stiffness changed, what its solver prepared at length.
  /// `before` is not to be solved again.
  void takeOver(WarmSolve& before, Host& host);
  /// Makes the solver ready, which the first solve otherwise does.
  void prepare(Host& host);
  /// Solves for the end of `plan`, whatever the status. Throws Cancelled; then the next solve begins where this one did.
  std::shared_ptr<const Motion> solve(const Plan& plan, Host& host);

 private:
  bool mayLeaveOut() const;   // whether points may stand still
  std::shared_ptr<const Scene> scene_;
  std::string id_;
  std::shared_ptr<const Scene> rest_;   // without the loads that the CT shows it under; the scene itself if there are none
  std::unique_ptr<Solver> solver_;
  Registry& registry_;
  Compiled compiled_;
  std::unique_ptr<Session> session_;   // null until it is made ready
  std::unique_ptr<RegionSolve> region_;   // in its place where points that stand still are left out
  NodeVectors start_;                  // empty: at rest
};

}  // namespace pectora
