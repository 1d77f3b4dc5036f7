// A table of figures against what is to be reached, as a picture: green where a figure reaches it, orange to red where not.
#pragma once

#include <string>
#include <vector>

namespace pectora {

struct Scorecard {
  std::string title;
  std::vector<std::string> columns;             ///< without the first one, which names the rows
  std::vector<std::string> rows;
  std::vector<std::vector<double>> values;      ///< [row][column]; not a number: unknown
  std::vector<double> goals;                    ///< one a column: the greatest absolute value that reaches it; 0: none
  std::vector<bool> isLeast;                    ///< one a column: the goal is the least value instead
};

/// Reads lines of comma separated cells, header first; the first cell of each is the row's name. `goals` belong to the columns
/// after it, in order, a negative one is a least value; missing ones are 0. Throws Error if a line has another number of cells.
Scorecard readScorecard(const std::string& title, const std::vector<std::string>& lines, const std::vector<double>& goals);

/// How far a value is from its goal: up to 1 reaches it; not a number where there is none.
double miss(double value, double goal, bool isLeast);

/// The commands that make gnuplot draw it into a PNG file.
std::string gnuplotCommands(const Scorecard& card, const std::string& pngPath);

}  // namespace pectora
