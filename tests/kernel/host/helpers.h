// A runner over the test plugins.
#pragma once

#include "kernel/host/runner.h"
#include "kernel/value/scene.h"
#include "kernel/value/volume.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace pectora {

struct RecordedMessages : Messages {
  std::vector<std::string> warnings;
  int fresh = 0, cached = 0;
  void warn(const std::string&, const std::string& message) override { warnings.push_back(message); }
  void finished(const Record&, bool isCached) override { ++(isCached ? cached : fresh); }
};

struct TestRunner {
  Registry registry{{PECTORA_TEST_PLUGINS}};
  RecordedMessages messages;
  std::atomic<bool> cancel{false};
  Runner runner{registry, messages, cancel};
};

/// The Error that a call throws; fails the test if it throws none.
template <class F>
Error errorOf(F&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error was thrown";
  return Error("none");
}

/// Whether a file is mapped into this process.
inline bool isMapped(const std::string& file) {
  std::ifstream maps("/proc/self/maps");
  std::ostringstream text;
  text << maps.rdbuf();
  return text.str().find(file) != std::string::npos;
}

/// An effect as a scene calls it.
inline std::shared_ptr<const EffectCall> call(const std::string& id, Settings settings = {}) {
  auto effect = std::make_shared<EffectCall>();
  effect->id = id;
  effect->settings = std::move(settings);
  return effect;
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace pectora
