#include "app/view/session/script_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pectora::view {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '\n') result += "\\n";
    else result += c;
  }
  return result + "\"";
}

std::string literal(const SettingValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* text = std::get_if<std::string>(&value)) return quoted(*text);
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) return fmt::format("{{ {} }}", fmt::join(*numbers, ", "));
  std::vector<std::string> texts;
  for (const std::string& text : std::get<std::vector<std::string>>(value)) texts.push_back(quoted(text));
  return fmt::format("{{ {} }}", fmt::join(texts, ", "));
}

std::string fields(const Settings& settings) {
  std::string text;
  for (const auto& [name, value] : settings) text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name, literal(value));
  return text;
}

// { a = 1 }, or "{}".
std::string table(const Settings& settings) { return settings.empty() ? "{}" : "{ " + fields(settings) + " }"; }
// ", { a = 1 }", or nothing.
std::string lastArgument(const Settings& settings) { return settings.empty() ? "" : ", " + table(settings); }

std::string effectList(const Choices& choices, const std::string& indent) {
  std::string text;
  for (const EffectChoice& effect : choices.effects)
    text += fmt::format("{}{}{}{},\n", indent, effect.isOn ? "" : "-- ", effect.plugin.id, table(effect.plugin.settings));
  return text;
}

std::string landmarkCall(const Landmarks& landmarks) {
  std::vector<std::string> names;
  std::vector<double> positions;
  for (const Landmark& l : landmarks.points) {
    names.push_back(l.name);
    positions.insert(positions.end(), {l.position.x, l.position.y, l.position.z});
  }
  return fmt::format("scan.landmarks{{\n  names = {},\n  positions = {} }}", literal(names), literal(positions));
}

// The comparison with skins of these names, where there is a scan and a way to bring it here; otherwise nothing.
std::string comparisonText(const Choices& c, const std::string& before, const std::string& after, const std::string& more) {
  const bool hasPhantom = c.source == Source::phantom;
  const bool hasLandmarks = c.ctLandmarks.points.size() >= 3 && c.scanLandmarks.points.size() >= 3;
  if (!(hasPhantom || c.hasScan()) || !(hasLandmarks || (hasPhantom && !c.hasScan()))) return "";
  std::string text = fmt::format("local scanned = {}\n", c.hasScan() ? c.scan.id + table(c.scan.settings) : "phantom_scan");
  if (hasLandmarks) {
    text += fmt::format("local on_scan = {}\n", landmarkCall(c.scanLandmarks));
    text += fmt::format("local on_ct = {}\n", landmarkCall(c.ctLandmarks));
  } else {
    text += "local on_scan, on_ct = scan_landmarks, ct_landmarks\n";
  }
  text += fmt::format("local aligned, by_landmarks =\n  {}(scanned, on_scan, on_ct{})\n", c.registration.id, lastArgument(c.registration.settings));
  if (c.usesIcp) text += fmt::format("local by_icp\naligned, by_icp = {}(aligned, {}, {}{})\n", c.icp.id, before, after, lastArgument(c.icp.settings));
  return text + fmt::format("local comparison = {}(aligned, {}, {{\n  {}, unchanged = {}{} }})\n\n", c.comparer.id, after, fields(c.comparer.settings), before, more);
}

}  // namespace

std::string scriptOf(const Choices& c) {
  std::string text = "-- What the Pectora window shows, as a script: pectora run FILE.lua\n";
  const bool hasPhantom = c.source == Source::phantom;
  if (c.source == Source::none) return text + "-- Nothing is open yet.\n";
  if (c.source == Source::result) {
    const std::string folder = std::get<std::string>(*find(c.loader.settings, "path"));
    text += fmt::format("local before = scan.file{{ path = {}, units = \"mm\" }}\n", quoted(folder + "/before.ply"));
    text += fmt::format("local after = scan.file{{ path = {}, units = \"mm\" }}\n\n", quoted(folder + "/after.ply"));
    return text + comparisonText(c, "before", "after", "") + "print(comparer.surface(before, after, { name = \"before_vs_after\", unchanged = before }))\n";
  }
  text += fmt::format("local ct{} = {}{}\n", hasPhantom ? ", truth, phantom_scan, ct_landmarks, scan_landmarks" : "", c.loader.id, table(c.loader.settings));
  text += fmt::format("local anatomy = {}(ct{})\n", c.segmenter.id, lastArgument(c.segmenter.settings));
  for (const PluginChoice& correction : c.corrections) text += fmt::format("anatomy = {}(anatomy{})\n", correction.id, lastArgument(correction.settings));
  text += fmt::format("local cage = {}(anatomy, ct{})\n\n", c.splines.id, lastArgument(c.splines.settings));
  // A lattice is made of the cage alone, a solid of the CT, too.
  text += fmt::format("local scene = {}(cage, {}{{\n", c.model.id, c.model.id == "model.two_layer" ? "" : "ct, ");
  if (!c.model.settings.empty()) text += "  " + fields(c.model.settings) + ",\n";
  text += "  effects = {\n" + effectList(c, "    ") + "  },\n})\n";
  text += fmt::format("local plan = {}(cage{})\n", c.planner.id, lastArgument(c.planner.settings));
  text += fmt::format("local motion = {}(scene, plan{})\n\n", c.solver.id, lastArgument(c.solver.settings));

  const std::string compared = comparisonText(c, "motion.before", "motion.after", ", copied = motion.copied");
  std::string lists;
  if (!compared.empty()) lists = fmt::format(",\n  registration = {{ by_landmarks{} }}, comparisons = {{ comparison }}, scan = aligned", c.usesIcp ? ", by_icp" : "");
  text += compared;
  text += "report.files{\n  ct = ct, anatomy = anatomy, cage = cage,\n  scene = scene, plan = plan, motion = motion" + lists + ",\n  path = \"result\" }\n";
  text += "print(plan)\nprint(motion)\n";
  return text + (compared.empty() ? "" : "print(comparison)\n");
}

std::string presetOf(const Choices& c) {
  std::string text = "-- A preset of the Pectora window.\n";
  text += "effects = {\n" + effectList(c, "  ") + "}\n";
  const auto part = [&](const char* name, const PluginChoice& plugin) {
    text += fmt::format("{0}_name = {1}\n{0}_settings = {2}\n", name, quoted(plugin.id), table(plugin.settings));
  };
  part("model", c.model);
  part("planner", c.planner);
  part("solver", c.solver);
  return text;
}

}  // namespace pectora::view
