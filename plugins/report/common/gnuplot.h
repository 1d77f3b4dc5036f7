// Pictures drawn by gnuplot.
#pragma once

#include "kernel/value/comparison.h"

#include <functional>
#include <memory>
#include <string>

namespace pectora {

/// A text in single quotes, in which gnuplot reads nothing but a doubled quote; line ends become blanks.
std::string inQuotes(const std::string& text);
/// Draws a picture to `path`, making its folder: `commandsFor` gives gnuplot's commands for the PNG file that is written aside first.
/// Throws Error if gnuplot is not installed or fails.
std::shared_ptr<const Report> drawPicture(const std::string& path, const std::function<std::string(const std::string& png)>& commandsFor);

}  // namespace pectora
