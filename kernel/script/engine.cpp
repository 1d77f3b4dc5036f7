#include "kernel/script/engine.h"

#include "kernel/script/state.h"

#include <algorithm>
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

// A fresh state: nothing of one script is seen by the next.
void renewState(ScriptState& state) {
  if (state.lua) lua_close(state.lua), state.lua = nullptr;
  state.stop = nullptr;
  state.declared.clear();
  state.hasDeclared = false;
  openState(state);
}

// Calls the function on the stack, or throws the error that a load left there. The message handler lies at index 1.
void call(ScriptState& state, int loaded, int arguments, int results) {
  lua_State* lua = state.lua;
  if (loaded == LUA_OK) loaded = lua_pcall(lua, arguments, results, 1);
  if (state.stop) std::rethrow_exception(state.stop);
  if (loaded == LUA_OK) return;
  if (const Error* error = script::toError(lua, -1)) throw Error(*error);
  const char* text = lua_tostring(lua, -1);
  throw Error(text ? text : "the script failed with an error that is no text");
}

void execute(ScriptState& state, const std::string& path) {
  const std::string code = readScript(path);
  const std::string name = std::filesystem::path(path).filename().string();
  state.scriptFolder = std::filesystem::path(path).parent_path().string();
  if (state.scriptFolder.empty()) state.scriptFolder = ".";
  renewState(state);
  lua_pushcfunction(state.lua, messageHandler);
  call(state, luaL_loadbufferx(state.lua, code.data(), code.size(), ("=" + name).c_str(), "t"), 0, 0);
}

// Pushes a global of the last script, past the rule that an unknown one is an error.
bool pushGlobal(ScriptState& state, const std::string& name) {
  if (!state.lua) return false;
  lua_settop(state.lua, 0);
  lua_pushglobaltable(state.lua);
  lua_pushstring(state.lua, name.c_str());
  lua_rawget(state.lua, -2);
  return true;
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

void ScriptEngine::evaluate(const std::string& code) {
  if (!state_->lua) renewState(*state_);
  lua_State* lua = state_->lua;
  lua_settop(lua, 0);
  script::armStop(lua);
  state_->onlyParameters = false;
  lua_pushcfunction(lua, messageHandler);
  // As an expression where it is one.
  const std::string expression = "return " + code;
  int loaded = luaL_loadbufferx(lua, expression.data(), expression.size(), "=console", "t");
  if (loaded != LUA_OK) {
    lua_pop(lua, 1);
    loaded = luaL_loadbufferx(lua, code.data(), code.size(), "=console", "t");
  }
  call(*state_, loaded, 0, LUA_MULTRET);
  const int results = lua_gettop(lua) - 1;
  if (results == 0) return;
  lua_getglobal(lua, "print");
  lua_insert(lua, 2);
  call(*state_, LUA_OK, results, 0);
}

void ScriptEngine::define(const std::string& name, const Handle& handle) {
  if (!state_->lua) renewState(*state_);
  script::pushHandle(state_->lua, handle);
  lua_setglobal(state_->lua, name.c_str());
}

std::vector<Handle> ScriptEngine::handles(const std::string& name) const {
  std::vector<Handle> found;
  if (!pushGlobal(*state_, name)) return found;
  lua_State* lua = state_->lua;
  if (lua_istable(lua, -1))
    for (lua_Integer i = 1; lua_rawgeti(lua, -1, i) != LUA_TNIL; ++i) {
      if (const Handle* handle = script::toHandle(lua, -1)) found.push_back(*handle);
      lua_pop(lua, 1);
    }
  lua_settop(lua, 0);
  return found;
}

Settings ScriptEngine::settings(const std::string& name) const {
  Settings found;
  if (!pushGlobal(*state_, name)) return found;
  lua_State* lua = state_->lua;
  if (lua_istable(lua, -1)) {
    lua_pushnil(lua);
    while (lua_next(lua, -2)) {
      if (lua_type(lua, -2) == LUA_TSTRING) {
        const std::string key = lua_tostring(lua, -2);
        found.emplace_back(key, script::toSetting(lua, -1, key));
      }
      lua_pop(lua, 1);
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  }
  lua_settop(lua, 0);
  return found;
}

std::string ScriptEngine::text(const std::string& name) const {
  if (!pushGlobal(*state_, name)) return "";
  const std::string found = lua_type(state_->lua, -1) == LUA_TSTRING ? lua_tostring(state_->lua, -1) : "";
  lua_settop(state_->lua, 0);
  return found;
}

}  // namespace pectora
