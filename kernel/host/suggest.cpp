#include "kernel/host/suggest.h"

#include <algorithm>
#include <numeric>

namespace pectora {
namespace {

// Levenshtein distance, one row at a time.
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row.back();
}

}  // namespace

std::string suggest(const std::string& given, const std::vector<std::string>& known) {
  std::string list, best;
  std::size_t bestDistance = std::max<std::size_t>(2, given.size() / 3) + 1;
  for (const std::string& name : known) {
    list += (list.empty() ? "" : ", ") + name;
    const std::size_t d = editDistance(given, name);
    if (d < bestDistance) bestDistance = d, best = name;
  }
  if (!best.empty()) return "Did you mean \"" + best + "\"?";
  return known.empty() ? "There are none" : "Known: " + list;
}

}  // namespace pectora
