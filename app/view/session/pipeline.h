// From choices to results, step by step, on the thread that calls it.
#pragma once

#include "app/view/session/effect_worth.h"
#include "app/view/session/live.h"
#include "app/view/session/results.h"
#include "app/view/session/script_calls.h"
#include "app/view/session/study.h"

#include "kernel/script/engine.h"

#include <chrono>
#include <functional>

namespace pectora::view {

/// Runs what changed and nothing else. The last motion stays warm: while the bar or a spring constant moves, the next
/// skin is solved from there; settle() then solves as the script does, from rest.
class Pipeline {
 public:
  using Show = std::function<void(std::shared_ptr<const Results>)>;
  /// `messages` gets what stages tell; `show` each new state of the results.
  Pipeline(Registry& registry, Messages& messages, std::atomic<bool>& cancel, Show show, std::function<void(const std::string&)> print);

  /// Up to the skin. `since` is when the change was made. Errors end in Results::error; throws Cancelled.
  void update(const Choices& wanted, std::chrono::steady_clock::time_point since);
  /// The skin as the script finds it, and what follows from it.
  void settle();
  /// Called by the solver's thread with positions on the way, at any rate.
  void preview(const NodeVectors& positions);
  /// The step that is being run.
  Step present() const { return present_.load(); }

  /// The springs that pull at a point of the skin, where the motion now is.
  std::vector<PickedSpring> springsAt(int point);
  /// What each effect that is on changes and costs; `progress` from 0 to 1. Throws Cancelled.
  std::vector<EffectWorth> measureEffects(const std::function<void(double, const std::string&)>& progress);
  /// What accuracy costs in the present scene. Throws Error and Cancelled.
  Study study(const std::function<void(double, const std::string&)>& progress);
  /// Runs report.files on all that there is. Throws Error.
  void exportTo(const std::string& folder);
  /// A line of the console, which sees the results as ct, anatomy, cage, scene, plan, motion, comparison.
  void evaluate(const std::string& code);
  /// The landmarks on the CT's skin and on the scan in a file that holds both. Throws Error.
  std::pair<Landmarks, Landmarks> landmarksIn(const std::string& path);
  /// As in opened_script.h.
  Choices openedScript(const Choices& present, const std::string& path);
  /// Called by the runner before each call.
  void starting(const std::string& id, const Settings& settings, const Runner::PortInputs& inputs);

 private:
  void runOne(Step step);
  void runFrom(Step first, Step last);
  void solveLive();
  void solveFromRest();
  /// The warm solve of the present scene. Throws Error.
  WarmSolve& warm();
  void show();

  Registry& registry_;
  Messages& messages_;
  std::atomic<bool>& cancel_;
  Show show_;
  Runner runner_;
  LiveSolve live_;
  ScriptEngine console_;
  std::atomic<Step> present_{Step::nothing};

  ScriptCalls* calls_ = nullptr;   // of the script that is being opened
  Choices done_;
  Step valid_ = Step::source;      // everything before this step belongs to done_
  bool hasFailed_ = false;
  bool keepsWall_ = false;         // the scene that is run takes other effects only
  Results results_;
  std::chrono::steady_clock::time_point since_, shown_;

  NodeVectors lastSeen_;           // of the live solve that runs
  bool showsWay_ = false;          // whether the solve that runs is to be seen on its way
};

}  // namespace pectora::view
