// Texts of `pectora list`, `describe`, `explain` and `run SCRIPT --help`.
#pragma once

#include "kernel/host/runner.h"

namespace pectora {

/// A line a plugin: id, version, summary. A broken plugin's line says what is wrong with it.
std::string listText(Registry& registry);
/// What a plugin does, takes and returns, with every parameter.
std::string describeText(Registry& registry, Runner& runner, const std::string& id);
std::string describeJson(Registry& registry, Runner& runner, const std::string& id);
/// Parameters one below the other: name, default, allowed, doc.
std::string parametersText(const std::vector<Parameter>& parameters);
std::string explanationText(const Explanation& explanation);

}  // namespace pectora
