#include "plugins/report/files/metrics_table.h"

#include "kernel/value/levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

// What each metric is made of; the letters are explained beside LevelMetrics.
struct Metric {
  const char* name;
  const char* unit;
  const char* formula;
  double (*of)(const LevelMetrics&);
};
// Not a number where a length that it is made of is not known.
double known(double length, double value) { return length > 0 ? value : NAN; }
constexpr Metric kMetrics[] = {
    {"transverse", "mm", "T, inner width", [](const LevelMetrics& m) { return known(m.transverse, m.transverse); }},
    {"sternum_to_vertebra", "mm", "B", [](const LevelMetrics& m) { return known(m.sternumToVertebra, m.sternumToVertebra); }},
    {"deepest_inner_wall", "mm", "C, front of the vertebra to the most anterior inner wall", [](const LevelMetrics& m) { return known(m.deepestInnerWall, m.deepestInnerWall); }},
    {"haller_index", "", "T / B", [](const LevelMetrics& m) { return known(m.sternumToVertebra, m.haller()); }},
    {"correction_index", "%", "100 (C - B) / C", [](const LevelMetrics& m) { return known(m.deepestInnerWall, m.correctionIndex()); }},
    {"depression", "mm", "C - B", [](const LevelMetrics& m) { return known(m.deepestInnerWall, m.depression()); }},
    {"depression_index", "", "C / B", [](const LevelMetrics& m) { return known(m.sternumToVertebra, m.depressionIndex()); }},
    {"asymmetry", "", "greater over lesser depth of the two halves", [](const LevelMetrics& m) { return known(std::min(m.rightDepth, m.leftDepth), m.asymmetry()); }},
    {"eccentricity", "mm", "deepest point of the sternum's back to the left of the vertebra", [](const LevelMetrics& m) { return known(m.sternumToVertebra, m.eccentricity); }},
    {"torsion", "deg", "of the sternum's section, positive: left side deeper", [](const LevelMetrics& m) { return known(m.sternumToVertebra, m.torsionDeg); }},
    {"flatness", "", "T / greater depth of the two halves", [](const LevelMetrics& m) { return known(std::min(m.rightDepth, m.leftDepth), m.flatness()); }},
    {"external_haller_index", "", "skin's width / its depth at the pit", [](const LevelMetrics& m) { return known(m.externalPit, m.externalHaller()); }},
    {"external_correction_index", "%", "100 (depth at the summit - depth at the pit) / depth at the summit, on the skin", [](const LevelMetrics& m) { return known(m.externalFront, m.externalCorrectionIndex()); }},
    {"concavity_area", "mm2", "between skin and convex hull from summit to summit", [](const LevelMetrics& m) { return known(m.externalPit, m.concavityArea); }},
};

}  // namespace

std::string metricsCsv(const MetricStates& states) {
  std::string csv = "state,z_mm";
  for (const Metric& metric : kMetrics) csv += fmt::format(",{}{}{}", metric.name, *metric.unit ? "_" : "", std::string(metric.unit) == "%" ? "percent" : metric.unit);
  csv += "\n";
  for (const auto& [state, levels] : states)
    for (const LevelMetrics& level : levels) {
      csv += fmt::format("{},{:.2f}", state, level.z);
      for (const Metric& metric : kMetrics) {
        const double value = metric.of(level);
        csv += std::isfinite(value) ? fmt::format(",{:.4f}", value) : ",";
      }
      csv += "\n";
    }
  return csv;
}

Json metricsJson(const MetricStates& states, double z) {
  Json json = Json::object();
  for (const auto& [state, levels] : states) {
    const auto level = std::min_element(levels.begin(), levels.end(), [&](const LevelMetrics& a, const LevelMetrics& b) { return std::abs(a.z - z) < std::abs(b.z - z); });
    if (level == levels.end()) continue;
    Json entry = Json::object();
    entry["level"] = {{"value", level->z}, {"unit", "mm"}, {"formula", "LPS z of the least B in the caudal half of the sternal body before the operation"}};
    for (const Metric& metric : kMetrics)
      if (const double value = metric.of(*level); std::isfinite(value)) entry[metric.name] = {{"value", value}, {"unit", metric.unit}, {"formula", metric.formula}};
    if (std::any_of(levels.begin(), levels.end(), [](const LevelMetrics& m) { return m.externalPit > 0; }))
      entry["concavity_volume"] = {{"value", concavityVolume(levels)}, {"unit", "mL"}, {"formula", "concavity_area over all levels of the sternum"}};
    json[state] = std::move(entry);
  }
  return json;
}

}  // namespace pectora
