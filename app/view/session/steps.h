// The steps from a file to a comparison: what each calls.
#pragma once

#include "app/view/session/results.h"

#include "kernel/host/runner.h"

namespace pectora::view {

/// Runs one step of the choices on what the steps before it left in `results`, and puts its own there. Of the motion it does
/// nothing: how that is solved, the pipeline decides. Throws Error and Cancelled.
void runStep(Step step, const Choices& choices, Runner& runner, Results& results);
/// In place of making the scene anew: the same wall with the effects of the choices. No stage made it, so it has no record. Throws Error.
void takeEffects(const Choices& choices, Runner& runner, Results& results);

}  // namespace pectora::view
