// Runs Lua scripts: a sandboxed state in which every plugin is a function.
#pragma once

#include "kernel/host/runner.h"

#include <functional>
#include <memory>

namespace pectora {

/// What a script may do and with what.
struct ScriptOptions {
  std::vector<std::string> requireFolders;            ///< where `require` looks, besides the script's own folder
  std::function<void(const std::string&)> print;      ///< a line that the script prints; none: nobody reads it
  std::size_t memoryLimit = std::size_t(256) << 20;   ///< bytes of Lua's own memory
};

/// One Lua state. Base, math, string and table are there, and `require` limited to scripts' folders; io, os, debug,
/// load and bytecode are not. Each stage is a global table of functions (`loader.dicom{ path = ... }`), values are handles whose facts
/// and parts can be read (`ct.slices`, `motion.after`). Errors carry the script's line and a traceback.
class ScriptEngine {
 public:
  struct State;
  ScriptEngine(Runner& runner, Registry& registry, std::atomic<bool>& cancel, ScriptOptions options);
  ~ScriptEngine();

  /// The parameters that the script declares with parameters{...}; it runs only up to there, or to its first call of a stage.
  std::vector<Parameter> parametersOf(const std::string& path);
  /// Runs a script with NAME=VALUE arguments, checked against its declared parameters.
  /// Throws Error, Cancelled or Explained.
  void run(const std::string& path, const std::vector<std::pair<std::string, std::string>>& arguments);
  /// Runs a piece of text in a state that lasts until the next script; an expression's value is printed. Throws as run does.
  void evaluate(const std::string& code);
  /// A global of that state.
  void define(const std::string& name, const Handle& handle);
  /// Globals of that state: a list of values that stages returned, a table of plain values by name, a text. Empty if there is
  /// none, or something else.
  std::vector<Handle> handles(const std::string& name) const;
  Settings settings(const std::string& name) const;
  std::string text(const std::string& name) const;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace pectora
