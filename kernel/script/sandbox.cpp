#include "kernel/script/state.h"

namespace pectora::script {
namespace {

// setmetatable without __gc: a finalizer would run outside of every limit.
int safeSetMetatable(lua_State* lua) {
  if (lua_istable(lua, 2)) {
    lua_pushliteral(lua, "__gc");
    if (lua_rawget(lua, 2) != LUA_TNIL) return luaL_error(lua, "__gc is not allowed in scripts");
    lua_pop(lua, 1);
  }
  lua_settop(lua, 2);
  lua_pushvalue(lua, lua_upvalueindex(1));
  lua_insert(lua, 1);
  lua_call(lua, 2, 1);
  return 1;
}

// Looks every thousand instructions whether to stop; once it must, at every single one, so that no pcall survives it.
void stopHook(lua_State* lua, lua_Debug*) {
  ScriptState& state = ScriptState::of(lua);
  if (!state.stop && state.cancel.load(std::memory_order_relaxed)) state.stop = std::make_exception_ptr(Cancelled());
  if (state.stop) raiseStop(lua);
}

}  // namespace

void raiseStop(lua_State* lua) {
  lua_sethook(lua, stopHook, LUA_MASKCOUNT, 1);
  luaL_error(lua, "stopped");
  std::terminate();  // luaL_error does not return
}

void armStop(lua_State* lua) {
  ScriptState::of(lua).stop = nullptr;
  lua_sethook(lua, stopHook, LUA_MASKCOUNT, 1000);
}

std::string callerLine(lua_State* lua) {
  lua_Debug info;
  for (int level = 0; lua_getstack(lua, level, &info); ++level) {
    lua_getinfo(lua, "Sl", &info);
    if (info.currentline > 0) return std::string(info.short_src) + ":" + std::to_string(info.currentline);
  }
  return "";
}

void openSandbox(lua_State* lua) {
  const luaL_Reg libraries[] = {{LUA_GNAME, luaopen_base},
                                {LUA_TABLIBNAME, luaopen_table},
                                {LUA_STRLIBNAME, luaopen_string},
                                {LUA_MATHLIBNAME, luaopen_math}};
  for (const luaL_Reg& library : libraries) {
    luaL_requiref(lua, library.name, library.func, 1);
    lua_pop(lua, 1);
  }
  // Other ways to code and files; xpcall's handler would run after a stop.
  for (const char* name : {"dofile", "loadfile", "load", "collectgarbage", "xpcall"}) {
    lua_pushnil(lua);
    lua_setglobal(lua, name);
  }
  lua_getglobal(lua, "string");
  lua_pushnil(lua);
  lua_setfield(lua, -2, "dump");
  lua_pop(lua, 1);
  lua_getglobal(lua, "setmetatable");
  lua_pushcclosure(lua, safeSetMetatable, 1);
  lua_setglobal(lua, "setmetatable");
  // Unpredictable numbers would break "same input, same result".
  lua_getglobal(lua, "math");
  lua_getfield(lua, -1, "randomseed");
  lua_pushinteger(lua, 1);
  lua_call(lua, 1, 0);
  lua_pop(lua, 1);
  armStop(lua);
}

}  // namespace pectora::script
