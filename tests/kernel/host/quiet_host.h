// A host for tests that need no messages.
#pragma once

#include "kernel/physics/system.h"
#include "kernel/stage/host.h"

namespace pectora {

/// Hears nothing, and counts what it is shown.
struct QuietHost : Host {
  int previews = 0;
  std::size_t nodes = 0;
  bool isCancelled = false;
  void progress(double, const std::string&) override {}
  bool cancelled() const override { return isCancelled; }
  void warn(const std::string&) override {}
  void info(const std::string&) override {}
  void preview(const NodeVectors& positions) override { ++previews, nodes = positions.size(); }
  std::string pluginFolder() const override { return ""; }
};

}  // namespace pectora
