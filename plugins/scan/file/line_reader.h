// Lines and numbers of a text in memory.
#pragma once

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace pectora {

/// Gives a text line by line, without its ends ("\n", "\r\n" or "\r").
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}

  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find_first_of("\r\n");
    line = rest_.substr(0, end);
    std::size_t skip = end == std::string_view::npos ? rest_.size() : end + 1;
    if (end != std::string_view::npos && rest_[end] == '\r' && skip < rest_.size() && rest_[skip] == '\n') ++skip;
    rest_.remove_prefix(skip);
    ++number_;
    return true;
  }
  int number() const { return number_; }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  int number_ = 0;
};

/// Takes the next word (separated by blanks, tabs, commas or semicolons) off the front of a line; empty at its end.
inline std::string_view takeWord(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(" \t,;");
  if (begin == std::string_view::npos) return line = {}, std::string_view();
  line.remove_prefix(begin);
  const std::size_t end = std::min(line.find_first_of(" \t,;"), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

/// The whole word as a number, or nothing. "nan" and "inf" are numbers here; who reads them decides.
inline std::optional<double> toNumber(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || word.empty()) return std::nullopt;
  return value;
}

inline std::optional<long long> toInteger(std::string_view word) {
  long long value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || word.empty()) return std::nullopt;
  return value;
}

}  // namespace pectora
