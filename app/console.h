// What the command line shows while stages run: log lines and a progress bar on stderr.
#pragma once

#include "kernel/host/runner.h"

#include <chrono>
#include <mutex>

namespace pectora {

/// Progress and log on stderr. A progress bar appears only on a terminal, colours only without NO_COLOR.
class Console final : public Messages {
 public:
  explicit Console(bool quiet);
  ~Console() override;

  void progress(const std::string& stage, double fraction, const std::string& what) override;
  void info(const std::string& stage, const std::string& message) override;
  void warn(const std::string& stage, const std::string& message) override;
  void finished(const Record& record, bool cached) override;
  void error(const std::string& message);

 private:
  void clearBar();
  std::mutex mutex_;
  bool quiet_, hasBar_ = false, isTerminal_;
  std::chrono::steady_clock::time_point lastBar_{};
};

}  // namespace pectora
