// A Lua file opened as choices.
#pragma once

#include "app/view/session/script_calls.h"

#include "kernel/script/engine.h"

namespace pectora::view {

/// The choices that a Lua file makes: a script's whole way, which is run up to its first prediction and comparison and writes
/// nothing, or a preset's tuning of the present ones. A script's parameter "ct" is given the present patient. While the script runs,
/// `listener` points to what must hear of each call before it is made. Throws Error and Cancelled.
Choices openedScript(const Choices& present, const std::string& path, Runner& runner, Registry& registry, Messages& messages,
                     std::atomic<bool>& cancel, ScriptCalls*& listener);

}  // namespace pectora::view
