#include "app/console.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace pectora {

Console::Console(bool quiet) : quiet_(quiet), isTerminal_(isatty(STDERR_FILENO)) {
  const char* noColor = std::getenv("NO_COLOR");
  auto logger = spdlog::stderr_color_mt("pectora", noColor && *noColor ? spdlog::color_mode::never : spdlog::color_mode::automatic);
  logger->set_pattern("%^%l%$: %v");
  logger->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
  spdlog::set_default_logger(std::move(logger));
}

Console::~Console() { clearBar(); }

void Console::clearBar() {
  if (hasBar_) std::fputs("\r\033[K", stderr);
  hasBar_ = false;
}

void Console::progress(const std::string& stage, double fraction, const std::string& what) {
  if (quiet_ || !isTerminal_) return;
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (now - lastBar_ < std::chrono::milliseconds(80)) return;
  lastBar_ = now;
  const int filled = int(24 * std::min(1.0, std::max(0.0, fraction)));
  std::fputs(fmt::format("\r\033[K[{:#<{}}{:.<{}}] {}: {}", "", filled, "", 24 - filled, stage, what).c_str(), stderr);
  std::fflush(stderr);
  hasBar_ = true;
}

void Console::info(const std::string& stage, const std::string& message) {
  const std::lock_guard lock(mutex_);
  clearBar();
  spdlog::info("{}: {}", stage, message);
}

void Console::warn(const std::string& stage, const std::string& message) {
  const std::lock_guard lock(mutex_);
  clearBar();
  spdlog::warn("{}: {}", stage, message);
}

void Console::finished(const Record& record, bool cached) {
  const std::lock_guard lock(mutex_);
  clearBar();
  if (cached) spdlog::info("{}: from the cache", record.stage);
  else spdlog::info("{}: {:.2f} s", record.stage, record.seconds);
}

void Console::error(const std::string& message) {
  const std::lock_guard lock(mutex_);
  clearBar();
  spdlog::error("{}", message);
}

}  // namespace pectora
