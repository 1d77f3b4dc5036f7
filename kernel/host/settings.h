// Reading, checking and writing a plugin's settings through its describe().
#pragma once

#include "kernel/stage/parameters.h"
#include "kernel/value/settings.h"

#include <functional>

namespace pectora {

/// One parameter as its plugin describes it.
struct Parameter {
  std::string name;
  std::string type;              ///< "number", "integer", "flag", "text", "choice", "numbers", "texts"
  std::string unit;
  Range hard, usual;
  std::vector<std::string> allowed;   ///< of a choice
  TextRole role = TextRole::plain;
  std::string doc;
  SettingValue value;            ///< default or present value
};

using Describe = std::function<void(Visitor&)>;

/// Every parameter with its present value.
std::vector<Parameter> parameters(const Describe& describe);

/// Sets what `given` names; all else keeps its value. Throws Error with the parameter, the value, what is allowed
/// and the nearest known name.
void applySettings(const Settings& given, const Describe& describe);

/// A value as one canonical text: 17 digits for numbers, so that equal text means equal value.
std::string canonicalText(const SettingValue& value);

/// "0 to 80 mm", "one of cup, saucer", "" if anything goes: for help and errors.
std::string allowedText(const Parameter& parameter);

/// Turns a word of the command line into a value of the parameter's type. Throws Error if it is not one.
SettingValue parseText(const Parameter& parameter, const std::string& word);

/// Throws Error if the value has the wrong type or lies outside the hard range.
/// Returns it in the parameter's own type (an integer-valued number for an integer, a path for a path).
SettingValue checked(const Parameter& parameter, const SettingValue& value);

}  // namespace pectora
