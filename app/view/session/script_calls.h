// What a script calls, as choices: so that a script can be opened and gone on with.
#pragma once

#include "app/view/session/choices.h"

#include "kernel/host/runner.h"

namespace pectora::view {

/// Listens to the calls of one script.
class ScriptCalls {
 public:
  /// A call that is about to be made. Throws Cancelled at the second solve and at a report: a window shows one prediction, and writes
  /// nothing unasked.
  void starting(const std::string& id, const Settings& settings, const Runner::PortInputs& inputs);
  /// Whether the script loads a patient; if not, it may be a preset.
  bool hasPatient() const { return choices_.source != Source::none; }
  /// Whether it has come to a solver, so that there are choices.
  bool hasPrediction() const { return hasPatient() && hasModel_ && hasPlan_ && hasSolve_; }
  /// The choices that lead to the same prediction and comparison. What the script did not call is as in `present`. Throws Error if
  /// it solved nothing, or for a chest that did not come from a CT by way of this window's steps.
  Choices choices(const Choices& present) const;

 private:
  Choices choices_;
  bool hasModel_ = false, hasPlan_ = false, hasSolve_ = false, hasRegistration_ = false;
};

}  // namespace pectora::view
