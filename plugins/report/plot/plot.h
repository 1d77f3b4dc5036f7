// A work-precision picture: cost to the right, error upwards, both logarithmic, drawn by gnuplot.
#pragma once

#include <string>
#include <vector>

namespace pectora {

/// One run: what it belongs to, what it cost, and its error.
struct WorkPoint {
  std::string series;
  double cost = 0, error = 0;
};

struct WorkPrecision {
  std::string title, costLabel, errorLabel;
  std::vector<WorkPoint> points;
  bool isJoined = true;      ///< the runs of a series by a line
  double floor = 0;          ///< error below which nothing is gained, a line; 0: none
  std::string floorLabel;
};

/// The runs that no other one beats in both cost and error, by rising cost.
std::vector<WorkPoint> paretoFront(std::vector<WorkPoint> points);

/// The commands that make gnuplot draw it into a PNG file. Points that are not positive and finite are left out, since a
/// logarithm has no place for them.
std::string gnuplotCommands(const WorkPrecision& picture, const std::string& pngPath);

}  // namespace pectora
