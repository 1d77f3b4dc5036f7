// The one thread that runs stages, so that the window never waits.
#pragma once

#include "app/view/session/pipeline.h"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

namespace pectora::view {

/// What the worker does at present.
struct Activity {
  bool isBusy = false;
  std::string stage, what;
  double fraction = 0;
  double seconds = 0;         ///< since it began
  bool isLive = false;        ///< follows a slider; no need to show it
};

struct LogLine {
  enum class Kind { info, warning, error, print, input } kind;
  std::string text;
};

/// The newest wish wins: what it makes obsolete is cancelled, and wishes in between are dropped.
class Worker final : public Messages {
 public:
  /// `wake` is called from any thread whenever there is something new to show.
  Worker(Registry& registry, std::function<void()> wake);
  ~Worker() override;

  /// Brings the results up to these choices. While `isDragging`, the skin is not yet settled.
  void want(const Choices& choices, bool isDragging);
  /// Something else, in order, before wishes. Its errors go to the log.
  void run(std::string name, std::function<void(Pipeline&)> task);
  void cancel();

  std::shared_ptr<const Results> results() const;
  Activity activity() const;
  /// The log since the last call.
  std::vector<LogLine> takeLog();
  void log(LogLine::Kind kind, const std::string& text);
  void progress(const std::string& stage, double fraction, const std::string& what) override;

 private:
  void info(const std::string& stage, const std::string& message) override { log(LogLine::Kind::info, stage + ": " + message); }
  void warn(const std::string& stage, const std::string& message) override { log(LogLine::Kind::warning, stage + ": " + message); }
  void starting(const std::string& id, const Settings& settings, const std::vector<std::vector<Handle>>& inputs) override {
    pipeline_.starting(id, settings, inputs);
  }
  void preview(const NodeVectors& positions) override { pipeline_.preview(positions); }
  void loop();

  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable condition_;
  bool isStopping_ = false, hasWish_ = false, isDragging_ = false, isUpdating_ = false;
  Choices wish_, running_;
  std::chrono::steady_clock::time_point wishedAt_, startedAt_, woken_;
  std::deque<std::pair<std::string, std::function<void(Pipeline&)>>> tasks_;
  std::shared_ptr<const Results> results_ = std::make_shared<const Results>();
  Activity activity_;
  std::vector<LogLine> log_;
  std::atomic<bool> cancel_{false};
  Pipeline pipeline_;
  std::thread thread_;
};

}  // namespace pectora::view
