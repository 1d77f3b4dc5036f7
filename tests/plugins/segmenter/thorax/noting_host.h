// A host that keeps warnings.
#pragma once

#include "tests/kernel/host/quiet_host.h"

#include <algorithm>
#include <string>
#include <vector>

struct NotingHost : pectora::QuietHost {
  std::vector<std::string> warnings;
  void warn(const std::string& message) override { warnings.push_back(message); }
  /// Whether a warning holds that text.
  bool warned(const std::string& text) const {
    return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& w) { return w.find(text) != std::string::npos; });
  }
};
