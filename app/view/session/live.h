// The solve that follows the mouse, kept warm, and what goes into any solve by hand.
#pragma once

#include "app/view/session/choices.h"

#include "kernel/host/runner.h"
#include "kernel/host/warm.h"

namespace pectora::view {

/// What a solver sees of the program.
class LiveHost : public Host {
 public:
  LiveHost(std::string stage, Messages& messages, const std::atomic<bool>& cancel) : stage_(std::move(stage)), messages_(messages), cancel_(cancel) {}
  void progress(double fraction, const std::string& what) override { messages_.progress(stage_, fraction, what); }
  bool cancelled() const override { return cancel_.load(std::memory_order_relaxed); }
  void warn(const std::string& message) override { messages_.warn(stage_, message); }
  void info(const std::string& message) override { messages_.info(stage_, message); }
  void preview(const NodeVectors& positions) override { messages_.preview(positions); }
  std::string pluginFolder() const override { return ""; }

 private:
  std::string stage_;
  Messages& messages_;
  const std::atomic<bool>& cancel_;
};

/// What the solver sees that follows a hand. A hand may move on sooner than a solver makes a step: it is stopped only when it has shown
/// one, as otherwise the skin would stay where it is as long as the hand moves.
class FollowingHost final : public LiveHost {
 public:
  using LiveHost::LiveHost;
  bool cancelled() const override { return shown_ >= 2 && LiveHost::cancelled(); }   // solvers show where they begin, too
  void preview(const NodeVectors& positions) override {
    LiveHost::preview(positions);
    ++shown_;
    checkCancel();
  }

 private:
  int shown_ = 0;
};

/// A solver with settings of its own. Throws Error.
std::unique_ptr<Solver> makeSolver(Registry& registry, const PluginChoice& choice);

/// From so many skin points on, what moves is solved by multigrid, whose steps do not grow with the wall.
inline constexpr int kFineWall = 1000;
/// Movements end when no point is estimated to be farther than this from rest, mm, or at this tolerance: less is not seen.
inline constexpr double kLiveAccuracy = 0.1, kLiveTolerance = 1e-4;

/// Remembers the compiled scene and the solver's session from one movement to the next.
class LiveSolve {
 public:
  explicit LiveSolve(Registry& registry) : registry_(registry) {}
  /// The warm solve of a scene for a chosen solver, made if it is not there yet; a new one begins where `motion` ended, if that
  /// belongs to such a scene. Throws Error.
  WarmSolve& ready(const std::shared_ptr<const Scene>& scene, const PluginChoice& solver, const Motion* motion, Host& host);
  /// Whether the next solve begins at a solved skin.
  bool isWarm() const { return isWarm_; }
  /// The next solve begins there. Nothing happens for another scene's motion.
  void startFrom(const Motion& motion);
  void forget() { warm_ = nullptr; }

 private:
  Registry& registry_;
  std::unique_ptr<WarmSolve> warm_;
  PluginChoice solver_;
  bool isWarm_ = false;
};

}  // namespace pectora::view
