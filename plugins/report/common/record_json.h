// Values and provenance as JSON.
#pragma once

#include "kernel/stage/stage.h"

#include <nlohmann/json.hpp>

namespace pectora {

using Json = nlohmann::ordered_json;

/// The facts of a value: { name: { value, unit } }; a number that is not finite becomes null.
Json factsJson(const Value& value);
/// The records that led to some values, each once, inputs before what was made from them. No times: see timingJson.
Json provenanceJson(const std::vector<Handle>& handles);
/// Seconds and peak memory of each of those stages, in the same order.
Json timingJson(const std::vector<Handle>& handles);

}  // namespace pectora
