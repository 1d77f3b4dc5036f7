#include "plugins/report/common/record_json.h"

#include <cmath>
#include <set>

namespace pectora {
namespace {

using RecordPointer = std::shared_ptr<const Record>;

void collect(const RecordPointer& record, std::set<std::string>& seen, std::vector<RecordPointer>& order) {
  if (!record || !seen.insert(record->key).second) return;
  for (const auto& [port, input] : record->inputs) collect(input, seen, order);
  order.push_back(record);
}

std::vector<RecordPointer> inOrder(const std::vector<Handle>& handles) {
  std::set<std::string> seen;
  std::vector<RecordPointer> order;
  for (const Handle& handle : handles) collect(handle.record, seen, order);
  return order;
}

}  // namespace

Json factsJson(const Value& value) {
  Json json = Json::object();
  for (const Fact& fact : value.facts()) {
    if (const double* number = std::get_if<double>(&fact.value)) {
      json[fact.name] = {{"value", std::isfinite(*number) ? Json(*number) : Json()}, {"unit", fact.unit}};
    } else {
      json[fact.name] = {{"value", std::get<std::string>(fact.value)}};
    }
  }
  return json;
}

Json provenanceJson(const std::vector<Handle>& handles) {
  Json list = Json::array();
  for (const RecordPointer& record : inOrder(handles)) {
    Json entry{{"stage", record->stage}, {"version", record->version}, {"key", record->key}};
    Json settings = Json::object(), inputs = Json::array();
    for (const auto& [name, value] : record->settings) settings[name] = value;
    for (const auto& [port, input] : record->inputs) inputs.push_back({{"port", port}, {"key", input->key}});
    entry["settings"] = std::move(settings);
    entry["inputs"] = std::move(inputs);
    if (!record->warnings.empty()) entry["warnings"] = record->warnings;
    list.push_back(std::move(entry));
  }
  return list;
}

Json timingJson(const std::vector<Handle>& handles) {
  Json list = Json::array();
  for (const RecordPointer& record : inOrder(handles))
    list.push_back({{"stage", record->stage}, {"key", record->key}, {"seconds", record->seconds}, {"cpu_seconds", record->cpuSeconds}, {"peak_megabytes", record->peakMegabytes}});
  return list;
}

}  // namespace pectora
