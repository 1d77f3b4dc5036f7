#include "app/view/session/catalog.h"

#include <algorithm>

namespace pectora::view {

Catalog::Catalog(Registry& registry) : registry_(registry) {}

std::vector<std::string> Catalog::ids(const std::string& stage) const {
  std::vector<std::string> found;
  for (const std::string& id : registry_.ids())
    if (id.starts_with(stage + ".")) found.push_back(id);
  return found;
}

const std::vector<Parameter>& Catalog::parameters(const std::string& id) {
  const auto known = known_.find(id);
  if (known != known_.end()) return known->second;
  std::vector<Parameter> found;
  try {
    found = runner_.parametersOf(id);
  } catch (const Error&) {
    // The run itself will say what is wrong with it.
  }
  return known_[id] = std::move(found);
}

double Catalog::number(const std::string& id, const Settings& settings, const std::string& name) {
  for (const auto& [known, value] : settings)
    if (known == name) return std::get<double>(value);
  for (const Parameter& p : parameters(id))
    if (p.name == name) return std::get<double>(p.value);
  return 0;
}

bool Catalog::takes(const std::string& id, const std::string& input) {
  try {
    const std::vector<Port>& ports = runner_.ports(id);
    return std::any_of(ports.begin(), ports.end(), [&](const Port& port) { return port.name == input; });
  } catch (const Error&) {
    return false;
  }
}

std::string Catalog::summary(const std::string& id) {
  try {
    return registry_.open(id).descriptor->summary;
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace pectora::view
