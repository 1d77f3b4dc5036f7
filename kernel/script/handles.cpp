// Values and errors as Lua sees them.
#include "kernel/script/state.h"

#include "kernel/host/suggest.h"

#include <fmt/format.h>

#include <new>

namespace pectora::script {
namespace {

constexpr const char* kHandleType = "pectora.value";
constexpr const char* kErrorType = "pectora.error";

void pushFact(lua_State* lua, const Fact& fact) {
  if (const double* number = std::get_if<double>(&fact.value)) lua_pushnumber(lua, *number);
  else lua_pushstring(lua, std::get<std::string>(fact.value).c_str());
}

// value.name: a fact, a part, `kind`, or what its stage took to make it: `seconds`, `cpu_seconds`, and a solver's
// `prepare_seconds` and `megabytes`.
int handleIndex(lua_State* lua) {
  const Handle& handle = *toHandle(lua, 1);
  const std::string name = luaL_checkstring(lua, 2);
  if (name == "kind") return lua_pushstring(lua, handle.value->kind()), 1;
  if (handle.record) {
    if (name == "seconds") return lua_pushnumber(lua, handle.record->seconds), 1;
    if (name == "cpu_seconds") return lua_pushnumber(lua, handle.record->cpuSeconds), 1;
    if (name == "prepare_seconds") return lua_pushnumber(lua, handle.record->prepareSeconds), 1;
    if (name == "megabytes") return lua_pushnumber(lua, handle.record->heldMegabytes), 1;
  }
  std::vector<std::string> known{"kind", "seconds", "cpu_seconds", "prepare_seconds", "megabytes"};
  for (const Fact& fact : handle.value->facts()) {
    if (fact.name == name) return pushFact(lua, fact), 1;
    known.push_back(fact.name);
  }
  for (auto& [partName, part] : handle.value->parts()) {
    if (partName == name) return part ? pushHandle(lua, {part, handle.record}) : lua_pushnil(lua), 1;
    known.push_back(partName);
  }
  throw Error("a value of kind " + std::string(handle.value->kind()) + " has no \"" + name + "\"").advise(suggest(name, known));
}

// The facts on one line each.
int handleToString(lua_State* lua) {
  const Handle& handle = *toHandle(lua, 1);
  std::string text = handle.value->kind();
  for (const Fact& fact : handle.value->facts()) {
    if (const double* number = std::get_if<double>(&fact.value))
      text += fmt::format("\n  {} = {:.6g}{}{}", fact.name, *number, fact.unit.empty() ? "" : " ", fact.unit);
    else
      text += fmt::format("\n  {} = {}", fact.name, std::get<std::string>(fact.value));
  }
  return lua_pushstring(lua, text.c_str()), 1;
}

int handleCollect(lua_State* lua) {
  static_cast<Handle*>(luaL_checkudata(lua, 1, kHandleType))->~Handle();
  return 0;
}

int errorToString(lua_State* lua) { return lua_pushstring(lua, toError(lua, 1)->what()), 1; }

int errorCollect(lua_State* lua) {
  static_cast<Error*>(luaL_checkudata(lua, 1, kErrorType))->~Error();
  return 0;
}

void makeMetatable(lua_State* lua, const char* type, std::initializer_list<luaL_Reg> functions) {
  luaL_newmetatable(lua, type);
  for (const luaL_Reg& f : functions) {
    lua_pushcfunction(lua, f.func);
    lua_setfield(lua, -2, f.name);
  }
  lua_pushliteral(lua, "locked");
  lua_setfield(lua, -2, "__metatable");
  lua_pop(lua, 1);
}

}  // namespace

void openHandles(lua_State* lua) {
  makeMetatable(lua, kHandleType,
                {{"__index", guarded<handleIndex>}, {"__tostring", guarded<handleToString>}, {"__gc", handleCollect}});
}

void openErrors(lua_State* lua) {
  makeMetatable(lua, kErrorType, {{"__tostring", guarded<errorToString>}, {"__gc", errorCollect}});
}

void pushHandle(lua_State* lua, Handle handle) {
  void* memory = lua_newuserdatauv(lua, sizeof(Handle), 0);
  new (memory) Handle(std::move(handle));
  luaL_setmetatable(lua, kHandleType);
}

const Handle* toHandle(lua_State* lua, int index) {
  return static_cast<const Handle*>(luaL_testudata(lua, index, kHandleType));
}

void pushError(lua_State* lua, const Error& error) {
  void* memory = lua_newuserdatauv(lua, sizeof(Error), 0);
  new (memory) Error(error);
  luaL_setmetatable(lua, kErrorType);
}

Error* toError(lua_State* lua, int index) { return static_cast<Error*>(luaL_testudata(lua, index, kErrorType)); }

SettingValue toSetting(lua_State* lua, int index, const std::string& name) {
  const int at = lua_absindex(lua, index);
  switch (lua_type(lua, at)) {
    case LUA_TBOOLEAN: return bool(lua_toboolean(lua, at));
    case LUA_TNUMBER: return lua_tonumber(lua, at);
    case LUA_TSTRING: return std::string(lua_tostring(lua, at));
    case LUA_TTABLE: {
      // A list, all of one type.
      std::vector<double> numbers;
      std::vector<std::string> texts;
      const lua_Integer length = luaL_len(lua, at);
      for (lua_Integer i = 1; i <= length; ++i) {
        lua_geti(lua, at, i);
        const int type = lua_type(lua, -1);
        if (type == LUA_TNUMBER) numbers.push_back(lua_tonumber(lua, -1));
        if (type == LUA_TSTRING) texts.push_back(lua_tostring(lua, -1));
        lua_pop(lua, 1);
      }
      if (lua_Integer(numbers.size()) == length) return numbers;
      if (lua_Integer(texts.size()) == length) return texts;
      throw Error("a list must hold numbers only, or texts only").of(name);
    }
    default:
      throw Error("wrong type").of(name).given(std::string("a ") + luaL_typename(lua, at)).allowed("a number, text, true or false, or a list");
  }
}

void pushSetting(lua_State* lua, const SettingValue& value) {
  const auto pushList = [lua](const auto& list, auto pushOne) {
    lua_createtable(lua, int(list.size()), 0);
    for (std::size_t i = 0; i < list.size(); ++i) {
      pushOne(list[i]);
      lua_seti(lua, -2, lua_Integer(i + 1));
    }
  };
  const auto pushNumber = [lua](double d) { lua_pushnumber(lua, d); };
  const auto pushText = [lua](const std::string& s) { lua_pushstring(lua, s.c_str()); };
  if (const bool* flag = std::get_if<bool>(&value)) lua_pushboolean(lua, *flag);
  if (const double* number = std::get_if<double>(&value)) pushNumber(*number);
  if (const auto* text = std::get_if<std::string>(&value)) pushText(*text);
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) pushList(*numbers, pushNumber);
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) pushList(*texts, pushText);
}

}  // namespace pectora::script
