#include "plugins/report/plot/plot.h"

#include "plugins/report/common/gnuplot.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

bool isDrawable(const WorkPoint& p) { return std::isfinite(p.cost) && std::isfinite(p.error) && p.cost > 0 && p.error > 0; }

std::string dataBlock(const std::string& name, const std::vector<WorkPoint>& points) {
  std::string text = "$" + name + " << EOD\n";
  for (const WorkPoint& p : points) text += fmt::format("{:.9g} {:.9g}\n", p.cost, p.error);
  return text + "EOD\n";
}

}  // namespace

std::vector<WorkPoint> paretoFront(std::vector<WorkPoint> points) {
  std::erase_if(points, [](const WorkPoint& p) { return !isDrawable(p); });
  std::stable_sort(points.begin(), points.end(), [](const WorkPoint& a, const WorkPoint& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.error < b.error;
  });
  std::vector<WorkPoint> front;
  for (const WorkPoint& p : points)
    if (front.empty() || p.error < front.back().error) front.push_back(p);
  return front;
}

std::string gnuplotCommands(const WorkPrecision& picture, const std::string& pngPath) {
  // Each series in the order of its first run.
  std::vector<std::pair<std::string, std::vector<WorkPoint>>> series;
  for (const WorkPoint& p : picture.points) {
    if (!isDrawable(p)) continue;
    auto found = std::find_if(series.begin(), series.end(), [&](const auto& s) { return s.first == p.series; });
    if (found == series.end()) found = series.insert(series.end(), {p.series, {}});
    found->second.push_back(p);
  }
  if (series.empty()) throw Error("there is no run with a positive cost and error to draw").of("points");
  const std::vector<WorkPoint> front = paretoFront(picture.points);

  std::string text = "set terminal pngcairo noenhanced size 1100,720 font 'DejaVu Sans,12' linewidth 1.4\n";
  text += "set output " + inQuotes(pngPath) + "\n";
  text += "set title " + inQuotes(picture.title) + "\nset xlabel " + inQuotes(picture.costLabel) + "\nset ylabel " + inQuotes(picture.errorLabel) + "\n";
  text += "set logscale xy\nset format x '%g'\nset format y '%g'\nset grid xtics ytics mxtics mytics back linecolor '#d8d8d8', linecolor '#eeeeee'\nset border linecolor '#808080'\n";
  text += "set key outside right top samplen 2 spacing 1.2\n";
  // A little room around what is drawn.
  double leastCost = INFINITY, mostCost = 0, leastError = picture.floor > 0 ? picture.floor : INFINITY, mostError = picture.floor;
  for (const auto& [name, points] : series)
    for (const WorkPoint& p : points) {
      leastCost = std::min(leastCost, p.cost), mostCost = std::max(mostCost, p.cost);
      leastError = std::min(leastError, p.error), mostError = std::max(mostError, p.error);
    }
  text += fmt::format("set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]\n", leastCost / 1.5, mostCost * 1.5, leastError / 1.8, mostError * 1.8);
  for (std::size_t i = 0; i < series.size(); ++i) text += dataBlock(fmt::format("series{}", i), series[i].second);
  text += dataBlock("front", front);
  // Colours that remain apart for the colour-blind (Okabe and Ito 2008).
  const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#a0a000"};
  text += "plot $front with lines linecolor '#c8c8c8' linewidth 4 title 'no other is better'";
  for (std::size_t i = 0; i < series.size(); ++i)
    text += fmt::format(", \\\n  $series{} with {} linecolor '{}' pointtype {} pointsize 1.2 title {}", i, picture.isJoined ? "linespoints" : "points", colours[i % 8], 4 + i % 8 * 2 % 12,
                        inQuotes(series[i].first));
  if (picture.floor > 0)
    text += fmt::format(", \\\n  {:.9g} with lines linecolor '#b00000' dashtype 2 title {}", picture.floor, inQuotes(picture.floorLabel));
  return text + "\n";
}

}  // namespace pectora
