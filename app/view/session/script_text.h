// The window's state as Lua.
#pragma once

#include "app/view/session/choices.h"

namespace pectora::view {

/// A script that does what the window shows: `pectora run FILE.lua`. A phantom's script is complete; a patient's names the
/// folder, and nothing else of him.
std::string scriptOf(const Choices& choices);

/// The tuning alone, as a Lua file of globals: effects, and the names and settings of model, planner and solver.
std::string presetOf(const Choices& choices);

}  // namespace pectora::view
