// How a plugin describes its settings: one line a parameter. The one list serves the script's checks,
// `pectora describe`, the window's sliders and the cache key.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace pectora {

/// Closed interval of allowed or usual values.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

enum class TextRole {
  plain,
  inputPath,   ///< a file or folder that is read: its bytes are part of the cache key
  outputPath,  ///< a file or folder that is written: not part of the cache key
};

/// Visits every parameter of a settings struct, to read or to set it. `hard` values are enforced, `usual` are the
/// slider's ends. The field's value at construction is the default.
class Visitor {
 public:
  virtual ~Visitor() = default;
  virtual void real(const char* name, double& field, const char* unit, Range hard, Range usual, const char* doc) = 0;
  virtual void integer(const char* name, int& field, const char* unit, Range hard, Range usual, const char* doc) = 0;
  virtual void flag(const char* name, bool& field, const char* doc) = 0;
  virtual void text(const char* name, std::string& field, TextRole role, const char* doc) = 0;
  virtual void choice(const char* name, std::string& field, std::vector<std::string> allowed, const char* doc) = 0;
  virtual void reals(const char* name, std::vector<double>& field, const char* unit, Range hard, const char* doc) = 0;
  virtual void texts(const char* name, std::vector<std::string>& field, TextRole role, const char* doc) = 0;
};

}  // namespace pectora
