// What the parts of the script engine share. Nothing outside kernel/script includes it.
#pragma once

#include "kernel/script/engine.h"

#include <lua.hpp>

#include <exception>

namespace pectora {

/// Thrown through a script once its parameters are known, when only they were asked for.
struct ParametersKnown : std::exception {};

struct ScriptEngine::State {
  Runner& runner;
  Registry& registry;
  std::atomic<bool>& cancel;
  ScriptOptions options;
  lua_State* lua = nullptr;
  std::size_t memory = 0;

  // Of the present run.
  std::string scriptFolder;
  std::vector<std::pair<std::string, std::string>> arguments;
  std::vector<Parameter> declared;
  bool onlyParameters = false;
  bool hasDeclared = false;
  std::exception_ptr stop;   // Cancelled, Explained or ParametersKnown: no pcall may swallow it

  State(Runner& r, Registry& g, std::atomic<bool>& c, ScriptOptions o)
      : runner(r), registry(g), cancel(c), options(std::move(o)) {}

  static State& of(lua_State* lua) { return **static_cast<State**>(lua_getextraspace(lua)); }
};

using ScriptState = ScriptEngine::State;

namespace script {

/// Opens the allowed libraries and removes what a script must not have.
void openSandbox(lua_State* lua);
/// Lets the next piece of a script run, looking for cancel as it goes.
void armStop(lua_State* lua);
/// Stops the script for good with the exception now held in State::stop.
[[noreturn]] void raiseStop(lua_State* lua);
/// "correction.lua:31" of the Lua function that called the running C function.
std::string callerLine(lua_State* lua);

/// Makes each stage a global table, and `parameters`, `print` and `require`.
void openBindings(lua_State* lua);
/// Pushes a value as a handle.
void pushHandle(lua_State* lua, Handle handle);
/// The handle at a stack index, or nullptr if it is none.
const Handle* toHandle(lua_State* lua, int index);
void openHandles(lua_State* lua);
/// Reads a plain Lua value: boolean, number, string, or list of numbers or of strings. Throws Error naming `name`.
SettingValue toSetting(lua_State* lua, int index, const std::string& name);
/// Pushes a setting as a plain Lua value.
void pushSetting(lua_State* lua, const SettingValue& value);
/// The function behind the global `parameters`.
int declareParameters(lua_State* lua);

/// An error as a Lua value: pcall hands it on, and it keeps its kind when it leaves the script.
void pushError(lua_State* lua, const Error& error);
/// The error at a stack index, or nullptr if it is another value.
Error* toError(lua_State* lua, int index);
void openErrors(lua_State* lua);

/// Wraps a C function that may throw: errors get the script's line and become Lua errors; cancel and the like stop
/// the script. Lua's own exceptions are none of std::exception, and pass.
template <int (*Function)(lua_State*)>
int guarded(lua_State* lua) {
  try {
    return Function(lua);
  } catch (Error& error) {
    pushError(lua, error.inScript(callerLine(lua)));
  } catch (const Cancelled&) {
    ScriptState::of(lua).stop = std::current_exception();
  } catch (const Explained&) {
    ScriptState::of(lua).stop = std::current_exception();
  } catch (const ParametersKnown&) {
    ScriptState::of(lua).stop = std::current_exception();
  } catch (const std::exception& error) {
    pushError(lua, Error(error.what(), ErrorKind::runFailed).inScript(callerLine(lua)));
  }
  if (ScriptState::of(lua).stop) raiseStop(lua);
  return lua_error(lua);
}

}  // namespace script
}  // namespace pectora
