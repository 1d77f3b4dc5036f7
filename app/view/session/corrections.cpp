#include "app/view/session/corrections.h"

#include <algorithm>
#include <cmath>

namespace pectora::view {
namespace {

std::vector<double> rounded(Vec3 p) {
  std::vector<double> list;
  for (int a = 0; a < 3; ++a) list.push_back(std::round(10 * p[a]) / 10);
  return list;
}

PluginChoice ribCall(const RibName& rib, int as) {
  PluginChoice call{"correct.rib", {{"as", double(as)}}};
  if (rib.number > 0) call.settings.emplace_back("number", double(rib.number));
  else call.settings.emplace_back("near", rounded(rib.near));
  call.settings.emplace_back("side", std::string(sideName(rib.side)));
  return call;
}

double numberOf(const PluginChoice& call, const char* name) {
  const SettingValue* value = find(call.settings, name);
  const double* number = value ? std::get_if<double>(value) : nullptr;
  return number ? *number : 0;
}

std::string wordOf(const PluginChoice& call, const char* name, const char* otherwise) {
  const SettingValue* value = find(call.settings, name);
  const auto* word = value ? std::get_if<std::string>(value) : nullptr;
  return word ? *word : otherwise;
}

}  // namespace

RibName nameOf(const Rib& rib) {
  if (rib.number > 0 || rib.centerline.empty()) return {rib.side, rib.number};
  return {rib.side, 0, rib.centerline[rib.centerline.size() / 2]};
}

const Rib* findRib(const Anatomy& anatomy, const RibName& name) {
  for (const Rib& rib : anatomy.ribs)
    if (nameOf(rib) == name) return &rib;
  return nullptr;
}

std::string ribText(const RibName& name) {
  return std::string(name.side == Side::right ? "Right" : "Left") + " rib " + (name.number > 0 ? std::to_string(name.number) : "?");
}

PluginChoice ribDropped(const RibName& rib) { return ribCall(rib, 0); }
PluginChoice ribRenumbered(const RibName& rib, int number) { return ribCall(rib, number); }

PluginChoice jointMoved(Joint joint, const RibName& rib, Vec3 to) {
  return {"correct.joint", {{"at", rounded(to)}, {"joint", std::string(joint == Joint::notch ? "notch" : "junction")},
                            {"number", double(rib.number)}, {"side", std::string(sideName(rib.side))}}};
}

void addCorrection(Choices& choices, PluginChoice correction) {
  const auto isSameJoint = [&](const PluginChoice& other) {
    const auto same = [&](const char* name) {
      const SettingValue *a = find(correction.settings, name), *b = find(other.settings, name);
      return a && b && *a == *b;
    };
    return other.id == "correct.joint" && correction.id == other.id && same("joint") && same("number") && same("side");
  };
  if (!choices.corrections.empty() && isSameJoint(choices.corrections.back())) choices.corrections.pop_back();
  choices.corrections.push_back(std::move(correction));
}

std::string correctionText(const PluginChoice& call) {
  std::string side = wordOf(call, "side", "right");
  side[0] = char(std::toupper(static_cast<unsigned char>(side[0])));
  const int number = int(numberOf(call, "number")), as = int(numberOf(call, "as"));
  const std::string which = number > 0 ? std::to_string(number) : "?";
  if (call.id == "correct.rib") return side + " rib " + which + (as > 0 ? " is " + std::to_string(as) : " left out");
  if (call.id == "correct.joint") return side + " " + wordOf(call, "joint", "junction") + " " + which + " moved";
  return wordOf(call, "structure", call.id.c_str()) + " drawn";
}

}  // namespace pectora::view
