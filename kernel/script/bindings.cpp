// One generic binding for all plugins: stage.name(inputs..., { settings }).
#include "kernel/script/state.h"

#include "kernel/host/suggest.h"
#include "kernel/value/scene.h"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace pectora::script {
namespace {

// Adds every installed effect that a list does not name yet, with its defaults.
void addAllEffects(lua_State* lua, std::vector<Handle>& inputs) {
  ScriptState& state = ScriptState::of(lua);
  for (const std::string& id : state.registry.ids()) {
    if (!id.starts_with("effect.")) continue;
    const bool isThere = std::any_of(inputs.begin(), inputs.end(), [&](const Handle& h) { return dynamic_cast<const EffectCall&>(*h.value).id == id; });
    if (!isThere) inputs.push_back(state.runner.run(id, {}, {}).front());
  }
}

// Adds the handle, or list of handles, at a stack index to the inputs of a port. Of effects, "auto" alone or as the last of a list
// stands for all that are installed.
void takeInput(lua_State* lua, int index, const Port& port, std::vector<Handle>& inputs) {
  const auto isAuto = [&](int i) { return port.isList && port.kinds.front() == std::string(EffectCall::kName) && lua_type(lua, i) == LUA_TSTRING && lua_tostring(lua, i) == std::string("auto"); };
  if (isAuto(index)) return addAllEffects(lua, inputs);
  if (const Handle* handle = toHandle(lua, index)) {
    inputs.push_back(*handle);
    return;
  }
  if (!port.isList || !lua_istable(lua, index))
    throw Error("this input must be a value that a stage returned").of(port.name).given(std::string("a ") + luaL_typename(lua, index));
  const lua_Integer length = luaL_len(lua, index);
  for (lua_Integer i = 1; i <= length; ++i) {
    lua_geti(lua, index, i);
    const Handle* handle = toHandle(lua, -1);
    if (!handle && i == length && isAuto(-1)) {
      addAllEffects(lua, inputs);
      lua_pop(lua, 1);
      return;
    }
    if (!handle) throw Error("every entry of this list must be a value that a stage returned").of(port.name);
    inputs.push_back(*handle);
    lua_pop(lua, 1);
  }
}

// Calls the plugin whose id is the first upvalue.
int callPlugin(lua_State* lua) {
  ScriptState& state = ScriptState::of(lua);
  if (state.onlyParameters) throw ParametersKnown();   // whoever begins to work has none to declare
  const std::string id = lua_tostring(lua, lua_upvalueindex(1));
  const std::vector<Port>& ports = state.runner.ports(id);
  Runner::PortInputs inputs(ports.size());
  Settings settings;

  try {
    // Leading values fill the ports in order; nil leaves one empty.
    const int arguments = lua_gettop(lua);
    int argument = 1;
    for (; argument <= arguments && !(lua_istable(lua, argument) && argument == arguments); ++argument) {
      if (std::size_t(argument) > ports.size())
        throw Error("too many inputs").given(std::to_string(arguments)).allowed(std::to_string(ports.size()) + " and a table of settings");
      if (!lua_isnil(lua, argument)) takeInput(lua, argument, ports[argument - 1], inputs[argument - 1]);
    }
    // The table holds settings, and inputs by name.
    if (argument <= arguments) {
      lua_pushnil(lua);
      while (lua_next(lua, argument)) {
        if (lua_type(lua, -2) != LUA_TSTRING) throw Error("settings are given by name: { name = value }");
        const std::string name = lua_tostring(lua, -2);
        bool isInput = false;
        for (std::size_t i = 0; i < ports.size(); ++i)
          if (ports[i].name == name) takeInput(lua, lua_gettop(lua), ports[i], inputs[i]), isInput = true;
        if (!isInput && toHandle(lua, -1)) {
          std::vector<std::string> names;
          for (const Port& port : ports) names.push_back(port.name);
          throw Error("there is no such input").of(name).advise(suggest(name, names));
        }
        if (!isInput) settings.emplace_back(name, toSetting(lua, -1, name));
        lua_pop(lua, 1);
      }
    }
  } catch (Error& error) {
    throw error.inStage(id);
  }
  const std::vector<Handle> handles = state.runner.run(id, settings, inputs);
  luaL_checkstack(lua, int(handles.size()), "too many results");
  for (const Handle& handle : handles) pushHandle(lua, handle);
  return int(handles.size());
}

// loader.dicom: a function that opens the plugin when it is called. The stage is the first upvalue.
int findPlugin(lua_State* lua) {
  ScriptState& state = ScriptState::of(lua);
  const std::string stage = lua_tostring(lua, lua_upvalueindex(1));
  const std::string id = stage + "." + luaL_checkstring(lua, 2);
  if (!state.registry.has(id)) state.registry.open(id);  // throws, with the nearest name
  lua_pushstring(lua, id.c_str());
  lua_pushcclosure(lua, guarded<callPlugin>, 1);
  return 1;
}

// A misspelt stage would be a nil global: say so, and which is nearest.
int unknownGlobal(lua_State* lua) {
  const std::string name = luaL_tolstring(lua, 2, nullptr);
  std::vector<std::string> known = ScriptState::of(lua).registry.stages();
  for (const char* builtin : {"parameters", "print", "require"}) known.push_back(builtin);
  throw Error("there is no stage or variable \"" + name + "\"").advise(suggest(name, known));
}

int print(lua_State* lua) {
  std::string line;
  for (int i = 1; i <= lua_gettop(lua); ++i) {
    line += (i > 1 ? "\t" : "") + std::string(luaL_tolstring(lua, i, nullptr));
    lua_pop(lua, 1);
  }
  if (const auto& show = ScriptState::of(lua).options.print) show(line);
  return 0;
}

// require "name": runs name.lua from the script's folder or the installed scripts, once.
int require(lua_State* lua) {
  ScriptState& state = ScriptState::of(lua);
  const std::string name = luaL_checkstring(lua, 1);
  for (char c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_')
      throw Error("a module's name has letters, digits and _ only").given(name);
  luaL_getsubtable(lua, LUA_REGISTRYINDEX, "pectora.modules");
  if (lua_getfield(lua, -1, name.c_str()) != LUA_TNIL) return 1;
  lua_pop(lua, 1);
  std::vector<std::string> folders{state.scriptFolder};
  folders.insert(folders.end(), state.options.requireFolders.begin(), state.options.requireFolders.end());
  for (const std::string& folder : folders) {
    std::ifstream file(folder + "/" + name + ".lua", std::ios::binary);
    if (!file) continue;
    std::ostringstream text;
    text << file.rdbuf();
    const std::string code = text.str();
    if (luaL_loadbufferx(lua, code.data(), code.size(), ("=" + name + ".lua").c_str(), "t") != LUA_OK) return lua_error(lua);
    lua_call(lua, 0, 1);
    if (lua_isnil(lua, -1)) lua_pop(lua, 1), lua_pushboolean(lua, 1);
    lua_pushvalue(lua, -1);
    lua_setfield(lua, -3, name.c_str());
    return 1;
  }
  throw Error("there is no module \"" + name + "\" in the scripts' folders").advise("Put " + name + ".lua beside the script");
}

}  // namespace

void openBindings(lua_State* lua) {
  for (const std::string& stage : ScriptState::of(lua).registry.stages()) {
    lua_newtable(lua);
    lua_newtable(lua);
    lua_pushstring(lua, stage.c_str());
    lua_pushcclosure(lua, guarded<findPlugin>, 1);
    lua_setfield(lua, -2, "__index");
    lua_setmetatable(lua, -2);
    lua_setglobal(lua, stage.c_str());
  }
  lua_register(lua, "print", guarded<print>);
  lua_register(lua, "require", guarded<require>);
  lua_register(lua, "parameters", guarded<declareParameters>);
  lua_pushglobaltable(lua);
  lua_newtable(lua);
  lua_pushcfunction(lua, guarded<unknownGlobal>);
  lua_setfield(lua, -2, "__index");
  lua_setmetatable(lua, -2);
  lua_pop(lua, 1);
}

}  // namespace pectora::script
