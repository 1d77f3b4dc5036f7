#include "kernel/script/engine.h"

#include "kernel/script/state.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace pectora {
namespace {

// Lua's memory, counted and limited.
void* allocate(void* user, void* block, std::size_t oldSize, std::size_t newSize) {
  ScriptState& state = *static_cast<ScriptState*>(user);
  const std::size_t held = block ? oldSize : 0;
  if (newSize == 0) {
    std::free(block);
    state.memory -= held;
    return nullptr;
  }
  if (state.memory - held + newSize > state.options.memoryLimit) return nullptr;
  void* grown = std::realloc(block, newSize);
  if (grown) state.memory += newSize - held;
  return grown;
}

// Adds a traceback to errors of the script itself; ours say their line already.
int messageHandler(lua_State* lua) {
  if (script::toError(lua, 1)) return 1;
  const char* message = lua_tostring(lua, 1);
  luaL_traceback(lua, lua, message ? message : luaL_tolstring(lua, 1, nullptr), 1);
  return 1;
}

std::string readScript(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path))
    throw Error("the script cannot be read").given(path).advise("Check the path of the .lua file");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void openState(ScriptState& state) {
  state.lua = lua_newstate(allocate, &state);
  if (!state.lua) throw std::bad_alloc();
  *static_cast<ScriptState**>(lua_getextraspace(state.lua)) = &state;
  script::openSandbox(state.lua);
  script::openErrors(state.lua);
  script::openHandles(state.lua);
  script::openBindings(state.lua);
}

// Every run has a fresh state: nothing of one script is seen by the next.
void execute(ScriptState& state, const std::string& path) {
  if (state.lua) lua_close(state.lua), state.lua = nullptr;
  state.stop = nullptr;
  state.declared.clear();
  state.hasDeclared = false;
  state.scriptFolder = std::filesystem::path(path).parent_path().string();
  if (state.scriptFolder.empty()) state.scriptFolder = ".";
  const std::string code = readScript(path);
  const std::string name = std::filesystem::path(path).filename().string();

  openState(state);
  lua_State* lua = state.lua;
  lua_pushcfunction(lua, messageHandler);
  int result = luaL_loadbufferx(lua, code.data(), code.size(), ("=" + name).c_str(), "t");
  if (result == LUA_OK) result = lua_pcall(lua, 0, 0, 1);
  if (state.stop) std::rethrow_exception(state.stop);
  if (result == LUA_OK) return;
  if (const Error* error = script::toError(lua, -1)) throw Error(*error);
  const char* text = lua_tostring(lua, -1);
  throw Error(text ? text : "the script failed with an error that is no text");
}

}  // namespace

ScriptEngine::ScriptEngine(Runner& runner, Registry& registry, std::atomic<bool>& cancel, ScriptOptions options)
    : state_(std::make_unique<State>(runner, registry, cancel, std::move(options))) {}

ScriptEngine::~ScriptEngine() {
  if (state_->lua) lua_close(state_->lua);
}

std::vector<Parameter> ScriptEngine::parametersOf(const std::string& path) {
  state_->onlyParameters = true;
  state_->arguments.clear();
  try {
    execute(*state_, path);
  } catch (const ParametersKnown&) {
  }
  return state_->declared;
}

void ScriptEngine::run(const std::string& path, const std::vector<std::pair<std::string, std::string>>& arguments) {
  state_->onlyParameters = false;
  state_->arguments = arguments;
  execute(*state_, path);
  if (!state_->hasDeclared && !arguments.empty())
    throw Error("the script takes no parameters").given(arguments.front().first);
}

}  // namespace pectora
