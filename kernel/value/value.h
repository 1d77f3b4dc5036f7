// What every value that passes between stages has in common.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace pectora {

/// One named figure or word of a value, as scripts and summaries show it.
struct Fact {
  std::string name;                       ///< snake_case, unique within the value
  std::variant<double, std::string> value;
  std::string unit;                       ///< "mm", "deg", "", ...
};

/// Base of all values. A value is built once by one stage and never changed after;
/// stages share it as std::shared_ptr<const T>. Every subclass T has `static constexpr const char* kName`,
/// the word by which signatures and error messages call it.
struct Value {
  virtual ~Value() = default;
  virtual const char* kind() const = 0;
  /// What a script can read (`ct.slices`) and a summary prints; empty by default.
  virtual std::vector<Fact> facts() const { return {}; }
  /// Memory that it holds, for the cache's budget; small values may leave it 0.
  virtual std::size_t bytes() const { return 0; }
  /// Values inside this one that a script can take out by name (`motion.after`); empty by default.
  virtual std::vector<std::pair<std::string, std::shared_ptr<const Value>>> parts() const { return {}; }
};

}  // namespace pectora
