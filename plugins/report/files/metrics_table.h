// The clinical metrics of every level, before and after, as a table and in the summary.
#pragma once

#include "plugins/report/common/record_json.h"

#include "kernel/value/anatomy.h"

namespace pectora {

/// "before", "predicted", "scan", each with its levels.
using MetricStates = std::vector<std::pair<std::string, std::vector<LevelMetrics>>>;

/// One row for every state and level: its lengths in mm and the indices made of them; an empty cell is not known.
std::string metricsCsv(const MetricStates& states);
/// For every state the metrics of the level nearest to z (value, unit, formula) and the concavity volume over all of its levels.
Json metricsJson(const MetricStates& states, double z);

}  // namespace pectora
