// Pictures drawn by gnuplot.
#pragma once

#include <string>

namespace pectora {

/// A text in single quotes, in which gnuplot reads nothing but a doubled quote; line ends become blanks.
std::string inQuotes(const std::string& text);
/// Runs gnuplot on these commands, which stand in the file `commandPath` meanwhile. Throws Error if it is not installed or fails.
void runGnuplot(const std::string& commands, const std::string& commandPath);

}  // namespace pectora
