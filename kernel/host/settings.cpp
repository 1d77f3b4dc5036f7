#include "kernel/host/settings.h"

#include "kernel/host/suggest.h"
#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace pectora {
namespace {

// Collects parameters.
class Reader final : public Visitor {
 public:
  std::vector<Parameter> found;

  void real(const char* name, double& field, const char* unit, Range hard, Range usual, const char* doc) override {
    found.push_back({name, "number", unit, hard, usual, {}, TextRole::plain, doc, field});
  }
  void integer(const char* name, int& field, const char* unit, Range hard, Range usual, const char* doc) override {
    found.push_back({name, "integer", unit, hard, usual, {}, TextRole::plain, doc, double(field)});
  }
  void flag(const char* name, bool& field, const char* doc) override {
    found.push_back({name, "flag", "", {}, {}, {}, TextRole::plain, doc, field});
  }
  void text(const char* name, std::string& field, TextRole role, const char* doc) override {
    found.push_back({name, "text", "", {}, {}, {}, role, doc, field});
  }
  void choice(const char* name, std::string& field, std::vector<std::string> allowed, const char* doc) override {
    found.push_back({name, "choice", "", {}, {}, std::move(allowed), TextRole::plain, doc, field});
  }
  void reals(const char* name, std::vector<double>& field, const char* unit, Range hard, const char* doc) override {
    found.push_back({name, "numbers", unit, hard, hard, {}, TextRole::plain, doc, field});
  }
  void texts(const char* name, std::vector<std::string>& field, TextRole role, const char* doc) override {
    found.push_back({name, "texts", "", {}, {}, {}, role, doc, field});
  }
};

// Sets fields from values that are already checked.
class Writer final : public Visitor {
 public:
  explicit Writer(const Settings& given) : given_(given) {}

  void real(const char* name, double& field, const char*, Range, Range, const char*) override {
    if (auto* v = find<double>(name)) field = *v;
  }
  void integer(const char* name, int& field, const char*, Range, Range, const char*) override {
    if (auto* v = find<double>(name)) field = int(*v);
  }
  void flag(const char* name, bool& field, const char*) override {
    if (auto* v = find<bool>(name)) field = *v;
  }
  void text(const char* name, std::string& field, TextRole, const char*) override {
    if (auto* v = find<std::string>(name)) field = *v;
  }
  void choice(const char* name, std::string& field, std::vector<std::string>, const char*) override {
    if (auto* v = find<std::string>(name)) field = *v;
  }
  void reals(const char* name, std::vector<double>& field, const char*, Range, const char*) override {
    if (auto* v = find<std::vector<double>>(name)) field = *v;
  }
  void texts(const char* name, std::vector<std::string>& field, TextRole, const char*) override {
    if (auto* v = find<std::vector<std::string>>(name)) field = *v;
  }

 private:
  template <class T>
  const T* find(const char* name) const {
    for (const auto& [key, value] : given_)
      if (key == name) return std::get_if<T>(&value);
    return nullptr;
  }
  const Settings& given_;
};

std::string rangeText(Range range, const std::string& unit) {
  const std::string suffix = unit.empty() ? "" : " " + unit;
  const bool low = std::isfinite(range.low), high = std::isfinite(range.high);
  if (low && high) return fmt::format("{:g} to {:g}{}", range.low, range.high, suffix);
  if (low) return fmt::format("{:g}{} or more", range.low, suffix);
  if (high) return fmt::format("{:g}{} or less", range.high, suffix);
  return "";
}

[[noreturn]] void refuse(const Parameter& parameter, const std::string& message, const SettingValue& value) {
  Error error(message);
  error.of(parameter.name).given(canonicalText(value)).allowed(allowedText(parameter));
  if (parameter.type == "choice" && std::holds_alternative<std::string>(value))
    error.advise(suggest(std::get<std::string>(value), parameter.allowed));
  throw error;
}

void checkNumber(const Parameter& parameter, double number, const SettingValue& value) {
  if (!std::isfinite(number)) refuse(parameter, "this is not a finite number", value);
  if (number < parameter.hard.low || number > parameter.hard.high) refuse(parameter, "out of range", value);
  if (parameter.type == "integer" && (number != std::floor(number) || std::abs(number) > 2147483647.0))
    refuse(parameter, "this is not a whole number", value);
}

}  // namespace

std::vector<Parameter> parameters(const Describe& describe) {
  Reader reader;
  describe(reader);
  return std::move(reader.found);
}

std::string canonicalText(const SettingValue& value) {
  struct {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(double d) const { return fmt::format("{:.17g}", d); }
    std::string operator()(const std::string& s) const { return s; }
    std::string operator()(const std::vector<double>& list) const {
      std::string text;
      for (double d : list) text += fmt::format("{}{:.17g}", text.empty() ? "" : ",", d);
      return text;
    }
    std::string operator()(const std::vector<std::string>& list) const {
      std::string text;
      for (const std::string& s : list) text += (text.empty() ? "" : ",") + s;
      return text;
    }
  } const writer;
  return std::visit(writer, value);
}

std::string allowedText(const Parameter& parameter) {
  if (parameter.type == "flag") return "true or false";
  if (parameter.type == "choice") {
    std::string list;
    for (const std::string& name : parameter.allowed) list += (list.empty() ? "one of " : ", ") + name;
    return list;
  }
  if (parameter.type == "text") return "text";
  if (parameter.type == "texts") return "a list of texts";
  const std::string range = rangeText(parameter.hard, parameter.unit);
  const std::string what = parameter.type == "integer" ? "a whole number" : parameter.type == "numbers" ? "numbers" : "a number";
  return range.empty() ? what + (parameter.unit.empty() ? "" : " in " + parameter.unit) : range;
}

SettingValue checked(const Parameter& parameter, const SettingValue& value) {
  const std::string& type = parameter.type;
  if (type == "number" || type == "integer") {
    if (const double* number = std::get_if<double>(&value)) return checkNumber(parameter, *number, value), value;
  } else if (type == "flag") {
    if (std::holds_alternative<bool>(value)) return value;
  } else if (type == "text") {
    if (std::holds_alternative<std::string>(value)) return value;
  } else if (type == "choice") {
    if (const std::string* word = std::get_if<std::string>(&value)) {
      for (const std::string& name : parameter.allowed)
        if (name == *word) return value;
      refuse(parameter, "unknown choice", value);
    }
  } else if (type == "numbers") {
    if (const double* number = std::get_if<double>(&value))
      return checked(parameter, SettingValue(std::vector<double>{*number}));
    if (const auto* list = std::get_if<std::vector<double>>(&value)) {
      for (double number : *list) checkNumber(parameter, number, value);
      return value;
    }
  } else if (type == "texts") {
    if (const std::string* word = std::get_if<std::string>(&value)) return std::vector<std::string>{*word};
    if (std::holds_alternative<std::vector<std::string>>(value)) return value;
    // An empty table says nothing of its type.
    if (const auto* list = std::get_if<std::vector<double>>(&value); list && list->empty())
      return std::vector<std::string>{};
  }
  refuse(parameter, "wrong type", value);
}

void applySettings(const Settings& given, const Describe& describe) {
  const std::vector<Parameter> known = parameters(describe);
  Settings good;
  for (const auto& [name, value] : given) {
    const Parameter* match = nullptr;
    for (const Parameter& parameter : known)
      if (parameter.name == name) match = &parameter;
    if (!match) {
      std::vector<std::string> names;
      for (const Parameter& parameter : known) names.push_back(parameter.name);
      throw Error("there is no such parameter").of(name).advise(suggest(name, names));
    }
    good.emplace_back(name, checked(*match, value));
  }
  Writer writer(good);
  describe(writer);
}

SettingValue parseText(const Parameter& parameter, const std::string& word) {
  if (parameter.type == "flag") {
    if (word == "true" || word == "yes" || word == "1") return true;
    if (word == "false" || word == "no" || word == "0") return false;
    refuse(parameter, "this is neither true nor false", SettingValue(word));
  }
  const auto number = [&](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0') refuse(parameter, "this is not a number", SettingValue(word));
    return value;
  };
  if (parameter.type == "number" || parameter.type == "integer") return number(word);
  if (parameter.type == "numbers" || parameter.type == "texts") {
    // A list is separated by commas.
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= word.size();) {
      const std::size_t end = std::min(word.find(',', begin), word.size());
      parts.push_back(word.substr(begin, end - begin));
      begin = end + 1;
    }
    if (parameter.type == "texts") return parts;
    std::vector<double> values;
    for (const std::string& part : parts) values.push_back(number(part));
    return values;
  }
  return word;
}

}  // namespace pectora
