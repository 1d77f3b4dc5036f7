// The nearest known name to a misspelt one.
#pragma once

#include <string>
#include <vector>

namespace pectora {

/// "Did you mean "x"?" if a known name is near, else the list of known names: a sentence for Error::advise.
std::string suggest(const std::string& given, const std::vector<std::string>& known);

}  // namespace pectora
