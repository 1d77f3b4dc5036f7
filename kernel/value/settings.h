// Settings of a stage as plain data: what a script gave, or every parameter with its value.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace pectora {

using SettingValue = std::variant<bool, double, std::string, std::vector<double>, std::vector<std::string>>;
/// Name and value, in the order in which they were given or described.
using Settings = std::vector<std::pair<std::string, SettingValue>>;

}  // namespace pectora
