#include "plugins/report/table/table.h"

#include "kernel/stage/error.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>

namespace pectora {
namespace {

nlohmann::ordered_json valueOf(const std::string& cell) {
  char* end = nullptr;
  const double number = std::strtod(cell.c_str(), &end);
  const bool isNumber = !cell.empty() && end == cell.c_str() + cell.size() && std::isfinite(number);
  return isNumber ? nlohmann::ordered_json(number) : nlohmann::ordered_json(cell);
}

}  // namespace

std::vector<std::string> csvCells(const std::string& line) {
  std::vector<std::string> cells{""};
  bool isQuoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && isQuoted && i + 1 < line.size() && line[i + 1] == '"') cells.back() += line[++i];
    else if (line[i] == '"') isQuoted = !isQuoted;
    else if (line[i] == ',' && !isQuoted) cells.emplace_back();
    else cells.back() += line[i];
  }
  return cells;
}

std::string tableJson(const std::vector<std::string>& lines) {
  auto rows = nlohmann::ordered_json::array();
  if (lines.empty()) return rows.dump() + "\n";
  const std::vector<std::string> names = csvCells(lines.front());
  for (std::size_t l = 1; l < lines.size(); ++l) {
    const std::vector<std::string> cells = csvCells(lines[l]);
    if (cells.size() != names.size())
      throw Error("a line has another number of cells than the header").of("lines").given(std::to_string(cells.size())).allowed(std::to_string(names.size())).at("line " + std::to_string(l + 1));
    nlohmann::ordered_json row;
    for (std::size_t i = 0; i < cells.size(); ++i) row[names[i]] = valueOf(cells[i]);
    rows.push_back(std::move(row));
  }
  return rows.dump(1) + "\n";
}

}  // namespace pectora
