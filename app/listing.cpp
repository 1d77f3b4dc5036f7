#include "app/listing.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace pectora {
namespace {

std::string shortText(const SettingValue& value) {
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{:g}", *number);
  if (const auto* list = std::get_if<std::vector<double>>(&value)) {
    std::string text;
    for (double number : *list) text += fmt::format("{}{:g}", text.empty() ? "" : ",", number);
    return text;
  }
  return canonicalText(value);
}

std::string portText(const Port& port) {
  std::string kinds;
  for (const char* kind : port.kinds) kinds += (kinds.empty() ? "" : " or ") + std::string(kind);
  return fmt::format("{}: {}{}{}", port.name, kinds, port.isList ? ", any number" : "", port.isOptional ? ", optional" : "");
}

nlohmann::ordered_json toJson(const SettingValue& value) {
  return std::visit([](const auto& v) { return nlohmann::ordered_json(v); }, value);
}

nlohmann::ordered_json toJson(Range range) {
  const auto end = [](double x) { return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(); };
  return {end(range.low), end(range.high)};
}

nlohmann::ordered_json toJson(const std::vector<Port>& ports) {
  auto list = nlohmann::ordered_json::array();
  for (const Port& port : ports)
    list.push_back({{"name", port.name}, {"kinds", port.kinds}, {"optional", port.isOptional}, {"list", port.isList}});
  return list;
}

}  // namespace

std::string listText(Registry& registry) {
  std::string text, stage;
  for (const std::string& id : registry.ids()) {
    const std::string itsStage = id.substr(0, id.find('.'));
    if (itsStage != stage) text += (text.empty() ? "" : "\n"), stage = itsStage;
    try {
      const Descriptor& d = *registry.open(id).descriptor;
      text += fmt::format("{:<22} {:<5} {}\n", id, d.version, d.summary);
    } catch (const Error& error) {
      text += fmt::format("{:<22} cannot be used: {}\n", id, error.what());
    }
  }
  return text;
}

std::string parametersText(const std::vector<Parameter>& parameters) {
  std::string text;
  for (const Parameter& p : parameters) {
    const std::string value = shortText(p.value);
    text += fmt::format("  {}{}\n", p.name, value.empty() ? "" : " = " + value + (p.unit.empty() ? "" : " " + p.unit));
    const std::string allowed = allowedText(p);
    text += fmt::format("      {}{}\n", p.doc, allowed.empty() || p.type == "text" ? "" : " [" + allowed + "]");
  }
  return text;
}

std::string describeText(Registry& registry, Runner& runner, const std::string& id) {
  const Descriptor& d = *registry.open(id).descriptor;
  std::string text = fmt::format("{} {}\n{}\n", d.id, d.version, d.summary);
  if (!d.references.empty()) text += "After: " + d.references + "\n";
  if (!runner.ports(id).empty()) text += "\nInputs\n";
  for (const Port& port : runner.ports(id)) text += "  " + portText(port) + "\n";
  text += "\nReturns\n";
  if (d.makeSolver) text += "  motion: Motion\n";
  if (d.makeEffect) text += "  an effect for a model's list of effects\n";
  for (const Port& port : d.outputs) text += "  " + portText(port) + "\n";
  const std::vector<Parameter> found = runner.parametersOf(id);
  text += found.empty() ? "\nNo parameters\n" : "\nParameters\n" + parametersText(found);
  return text;
}

std::string describeJson(Registry& registry, Runner& runner, const std::string& id) {
  const Descriptor& d = *registry.open(id).descriptor;
  nlohmann::ordered_json json{{"id", d.id}, {"version", d.version}, {"summary", d.summary}, {"references", d.references},
                              {"inputs", toJson(runner.ports(id))}, {"outputs", toJson(d.outputs)}};
  auto list = nlohmann::ordered_json::array();
  for (const Parameter& p : runner.parametersOf(id)) {
    nlohmann::ordered_json entry{{"name", p.name}, {"type", p.type}, {"unit", p.unit}, {"default", toJson(p.value)}, {"doc", p.doc}};
    if (p.type == "number" || p.type == "integer" || p.type == "numbers") entry["range"] = toJson(p.hard), entry["slider"] = toJson(p.usual);
    if (p.type == "choice") entry["choices"] = p.allowed;
    if (p.role != TextRole::plain) entry["role"] = p.role == TextRole::inputPath ? "input" : "output";
    list.push_back(std::move(entry));
  }
  json["parameters"] = std::move(list);
  return json.dump(2) + "\n";
}

std::string explanationText(const Explanation& e) {
  std::string text = fmt::format("{}: {} skin points, {} unknown positions, {} anchors on ribs, cartilages and sternum\n\n",
                                 e.solver, e.skinPoints, e.freeNodes, e.anchors);
  text += fmt::format("{:<24} {:<6} {:>9} {:>10} {:>8}  {}\n", "effect", "runs", "springs", "RMS, mm", "max, mm", "why, or with what");
  for (const EffectUse& use : e.effects) {
    std::string notes = use.isActive ? "called by the scene" : use.reason;
    for (const std::string& note : use.notes) notes += "; " + note;
    if (!use.notProbed.empty()) notes += "; " + use.notProbed;
    const auto figure = [](double mm) { return std::isnan(mm) ? std::string("-") : fmt::format("{:.2f}", mm); };
    text += fmt::format("{:<24} {:<6} {:>9} {:>10} {:>8}  {}\n", use.id, use.isActive ? "yes" : "no", use.springs, figure(use.changeRms), figure(use.changeMax), notes);
  }
  text += fmt::format("RMS and max: how far the skin lies elsewhere without the effect, where the operation moves it by more than 3 mm,\n"
                      "probed by rough solves{}\n", std::isnan(e.uncertainty) ? "" : fmt::format("; the RMS is right to about {:.2f} mm", e.uncertainty));
  text += fmt::format("\n{:<44} {}\n", "term (all stencils share one pass)", "ms an evaluation, measured here");
  for (const auto& [name, milliseconds] : e.termMilliseconds) text += fmt::format("{:<44} {:.3f}\n", name, milliseconds);
  return text;
}

}  // namespace pectora
