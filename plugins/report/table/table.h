// Tables of a script, as CSV and as JSON.
#pragma once

#include <string>
#include <vector>

namespace pectora {

/// The cells of a line of CSV. A cell in double quotes may hold commas, and two quotes for one.
std::vector<std::string> csvCells(const std::string& line);

/// An array with one object a line, named by the cells of the first; what reads wholly as a number is one. Throws Error where a
/// line has another number of cells than the header.
std::string tableJson(const std::vector<std::string>& lines);

}  // namespace pectora
