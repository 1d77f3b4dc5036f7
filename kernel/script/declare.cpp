// parameters{ {...}, ... }: how a script declares what it can be given.
#include "kernel/script/state.h"

#include "kernel/host/suggest.h"

namespace pectora::script {
namespace {

// A text field of the table on top of the stack, or "".
std::string textField(lua_State* lua, const char* key) {
  std::string text;
  if (lua_getfield(lua, -1, key) == LUA_TSTRING) text = lua_tostring(lua, -1);
  lua_pop(lua, 1);
  return text;
}

std::string typeOf(const SettingValue& value) {
  static constexpr const char* kTypes[] = {"flag", "number", "text", "numbers", "texts"};
  return kTypes[value.index()];
}

// One entry: { name =, default =, unit =, range = { low, high }, choices = { ... }, role = "input"|"output", doc = }.
// The default says the type; without one the parameter is a text, nil unless it is given.
Parameter readEntry(lua_State* lua) {
  Parameter p;
  p.name = textField(lua, "name");
  if (p.name.empty()) throw Error("a parameter needs a name: { name = \"lift\", default = 30, doc = \"...\" }");
  p.unit = textField(lua, "unit");
  p.doc = textField(lua, "doc");
  p.type = "text";
  p.value = std::string();
  if (lua_getfield(lua, -1, "default") != LUA_TNIL) {
    p.value = toSetting(lua, -1, p.name);
    p.type = typeOf(p.value);
  }
  lua_pop(lua, 1);
  if (lua_getfield(lua, -1, "range") == LUA_TTABLE) {
    const SettingValue range = toSetting(lua, -1, p.name);
    if (const auto* ends = std::get_if<std::vector<double>>(&range); ends && ends->size() == 2) p.hard = p.usual = {(*ends)[0], (*ends)[1]};
    else throw Error("a range has two numbers: { low, high }").of(p.name);
  }
  lua_pop(lua, 1);
  if (lua_getfield(lua, -1, "choices") == LUA_TTABLE) {
    const SettingValue choices = toSetting(lua, -1, p.name);
    if (const auto* list = std::get_if<std::vector<std::string>>(&choices)) p.allowed = *list;
    p.type = "choice";
  }
  lua_pop(lua, 1);
  const std::string role = textField(lua, "role");
  if (role == "input") p.role = TextRole::inputPath;
  if (role == "output") p.role = TextRole::outputPath;
  return p;
}

}  // namespace

int declareParameters(lua_State* lua) {
  ScriptState& state = ScriptState::of(lua);
  luaL_checktype(lua, 1, LUA_TTABLE);
  if (state.hasDeclared) throw Error("parameters{...} may be called once in a script");
  state.hasDeclared = true;
  const lua_Integer length = luaL_len(lua, 1);
  for (lua_Integer i = 1; i <= length; ++i) {
    if (lua_geti(lua, 1, i) != LUA_TTABLE) throw Error("every entry of parameters{...} is a table");
    state.declared.push_back(readEntry(lua));
    lua_pop(lua, 1);
  }
  if (state.onlyParameters) throw ParametersKnown();

  // Arguments replace the defaults; an empty text without a default stays nil in the script.
  for (const auto& [name, word] : state.arguments) {
    bool found = false;
    std::vector<std::string> names;
    for (Parameter& p : state.declared) {
      names.push_back(p.name);
      if (p.name != name) continue;
      p.value = checked(p, parseText(p, word));
      found = true;
    }
    if (!found) throw Error("the script has no such parameter").of(name).advise(suggest(name, names));
  }
  lua_newtable(lua);
  for (const Parameter& p : state.declared) {
    const std::string* text = std::get_if<std::string>(&p.value);
    if (text && text->empty()) continue;
    pushSetting(lua, p.value);
    lua_setfield(lua, -2, p.name.c_str());
  }
  return 1;
}

}  // namespace pectora::script
