#include "plugins/report/scorecard/scorecard.h"

#include "plugins/report/common/gnuplot.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace pectora {
namespace {

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> list(1);
  for (const char c : line) {
    if (c == ',') list.emplace_back();
    else list.back() += c;
  }
  return list;
}

// As short as it can be read.
std::string shortText(double value) {
  if (!std::isfinite(value)) return "-";
  const double size = std::abs(value);
  return size == std::round(value) && size < 1000 ? fmt::format("{:.0f}", value) : size < 0.1 ? fmt::format("{:.3f}", value) : fmt::format("{:.2f}", value);
}

std::string words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

}  // namespace

Scorecard readScorecard(const std::string& title, const std::vector<std::string>& lines, const std::vector<double>& goals) {
  if (lines.size() < 2) throw Error("a table needs a header and a line or more").of("lines").given(std::to_string(lines.size()) + " lines");
  Scorecard card;
  card.title = title;
  card.columns = cells(lines[0]);
  for (std::size_t n = 1; n < lines.size(); ++n) {
    const std::vector<std::string> line = cells(lines[n]);
    if (line.size() != card.columns.size())
      throw Error("a line has another number of cells than the header").of("lines").given(lines[n]).allowed(std::to_string(card.columns.size()) + " cells");
    card.rows.push_back(line[0]);
    std::vector<double> values;
    for (std::size_t c = 1; c < line.size(); ++c) {
      char* end = nullptr;
      const double value = std::strtod(line[c].c_str(), &end);
      values.push_back(line[c].empty() || *end != '\0' ? NAN : value);
    }
    card.values.push_back(std::move(values));
  }
  card.columns.erase(card.columns.begin());
  for (std::size_t c = 0; c < card.columns.size(); ++c) {
    const double goal = c < goals.size() ? goals[c] : 0;
    card.goals.push_back(std::abs(goal));
    card.isLeast.push_back(goal < 0);
  }
  return card;
}

double miss(double value, double goal, bool isLeast) {
  if (goal <= 0 || !std::isfinite(value)) return NAN;
  return isLeast ? (value >= goal ? 0.0 : 1 + (goal - value) / goal) : std::abs(value) / goal;
}

std::string gnuplotCommands(const Scorecard& card, const std::string& pngPath) {
  const std::size_t columns = card.columns.size(), rows = card.rows.size();
  std::string text = fmt::format("set terminal pngcairo noenhanced size {},{} font 'DejaVu Sans,11'\n", 240 + 96 * columns, 150 + 26 * rows);
  text += "set output " + inQuotes(pngPath) + "\nset title " + inQuotes(card.title) + "\n";
  text += "unset key\nunset colorbox\nset bmargin 5\nset tics textcolor '#303030'\nset border linecolor '#a0a0a0'\nset cbrange [0:2]\n";
  text += "set palette defined (0 '#e4f3e4', 0.999 '#c2e3c2', 1.0 '#fdebc8', 2 '#e79a84')\n";
  text += fmt::format("set xrange [-0.5:{}.5]\nset yrange [{}.5:-0.5]\n", columns - 1, rows - 1);
  // Names, with the goal below the column's.
  text += "set xtics scale 0 font ',9' (";
  for (std::size_t c = 0; c < columns; ++c) {
    // A long name goes over two lines.
    std::string name = words(card.columns[c]);
    if (name.size() > 12)
      if (const auto at = name.find(' ', name.size() / 3); at != std::string::npos) name[at] = '\n';
    std::string escaped;
    for (const char ch : name) escaped += ch == '\n' ? "\\n" : std::string(1, ch);
    const std::string goal = card.goals[c] > 0 ? fmt::format("{} {:g}", card.isLeast[c] ? ">=" : "<=", card.goals[c]) : "";
    text += fmt::format("{}\"{}\\n{}\" {}", c ? ", " : "", escaped, goal, c);
  }
  text += ")\nset ytics scale 0 (";
  for (std::size_t r = 0; r < rows; ++r) text += fmt::format("{}{} {}", r ? ", " : "", inQuotes(words(card.rows[r])), r);
  text += ")\nset datafile missing '?'\n$cells << EOD\n";
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      const double off = miss(card.values[r][c], card.goals[c], card.isLeast[c]);
      text += fmt::format("{} {} {} {}\n", c, r, std::isfinite(off) ? fmt::format("{:.4f}", std::min(off, 2.0)) : "NaN", shortText(card.values[r][c]));
    }
  text += "EOD\nplot $cells using 1:2:3 with image, $cells using 1:2:4 with labels font ',10'\n";
  return text;
}

}  // namespace pectora
