// A host that keeps warnings and can cancel.
#pragma once

#include "kernel/stage/host.h"

#include <vector>

struct QuietHost : pectora::Host {
  std::vector<std::string> warnings;
  double lastProgress = 0;
  bool isCancelled = false;

  void progress(double fraction, const std::string&) override { lastProgress = fraction; }
  bool cancelled() const override { return isCancelled; }
  void warn(const std::string& message) override { warnings.push_back(message); }
  void info(const std::string&) override {}
  std::string pluginFolder() const override { return ""; }
  /// Whether a warning holds that text.
  bool warned(const std::string& text) const {
    for (const std::string& w : warnings)
      if (w.find(text) != std::string::npos) return true;
    return false;
  }
};
