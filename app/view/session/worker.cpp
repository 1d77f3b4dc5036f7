#include "app/view/session/worker.h"

namespace pectora::view {

using Clock = std::chrono::steady_clock;

Worker::Worker(Registry& registry, std::function<void()> wake)
    : wake_(std::move(wake)),
      pipeline_(registry, *this, cancel_,
                [this](std::shared_ptr<const Results> results) {
                  {
                    const std::lock_guard lock(mutex_);
                    results_ = std::move(results);
                  }
                  wake_();
                },
                [this](const std::string& line) { log(LogLine::Kind::print, line); }),
      thread_([this] { loop(); }) {}

Worker::~Worker() {
  {
    const std::lock_guard lock(mutex_);
    isStopping_ = true;
    cancel_ = true;
  }
  condition_.notify_all();
  thread_.join();
}

void Worker::want(const Choices& choices, bool isDragging) {
  const std::lock_guard lock(mutex_);
  // What runs is stopped only if it rests on what has changed.
  const Step changed = firstDifference(running_, choices);
  if (isUpdating_ && changed != Step::nothing && changed <= pipeline_.present()) cancel_ = true;
  wish_ = choices;
  isDragging_ = isDragging;
  if (!hasWish_) wishedAt_ = Clock::now();
  hasWish_ = true;
  condition_.notify_all();
}

void Worker::run(std::string name, std::function<void(Pipeline&)> task) {
  const std::lock_guard lock(mutex_);
  tasks_.emplace_back(std::move(name), std::move(task));
  condition_.notify_all();
}

void Worker::cancel() {
  const std::lock_guard lock(mutex_);
  cancel_ = true;
  tasks_.clear();
}

std::shared_ptr<const Results> Worker::results() const {
  const std::lock_guard lock(mutex_);
  return results_;
}

Activity Worker::activity() const {
  const std::lock_guard lock(mutex_);
  Activity now = activity_;
  now.seconds = now.isBusy ? std::chrono::duration<double>(Clock::now() - startedAt_).count() : 0;
  now.isBusy = now.isBusy || hasWish_ || !tasks_.empty();   // what waits is work, too
  return now;
}

std::vector<LogLine> Worker::takeLog() {
  const std::lock_guard lock(mutex_);
  return std::exchange(log_, {});
}

void Worker::log(LogLine::Kind kind, const std::string& text) {
  {
    const std::lock_guard lock(mutex_);
    log_.push_back({kind, text});
  }
  wake_();
}

void Worker::progress(const std::string& stage, double fraction, const std::string& what) {
  {
    const std::lock_guard lock(mutex_);
    activity_.stage = stage, activity_.fraction = fraction, activity_.what = what;
    const auto now = Clock::now();
    if (now - woken_ < std::chrono::milliseconds(60)) return;
    woken_ = now;
  }
  wake_();
}

void Worker::loop() {
  std::unique_lock lock(mutex_);
  for (;;) {
    condition_.wait(lock, [this] { return isStopping_ || hasWish_ || !tasks_.empty(); });
    if (isStopping_) return;
    cancel_ = false;
    startedAt_ = Clock::now();
    activity_ = {true, "", "", 0, 0, isDragging_};
    std::function<void()> work;
    if (!tasks_.empty()) {
      activity_.stage = tasks_.front().first;
      activity_.isLive = false;
      work = [this, task = std::move(tasks_.front().second)] { task(pipeline_); };
      tasks_.pop_front();
    } else {
      running_ = wish_;
      hasWish_ = false;
      isUpdating_ = true;
      work = [this, dragging = isDragging_, since = wishedAt_] {
        pipeline_.update(running_, since);
        if (!dragging) pipeline_.settle();
      };
    }
    lock.unlock();
    try {
      work();
    } catch (const Cancelled&) {
    } catch (const std::exception& error) {
      log(LogLine::Kind::error, error.what());
    }
    lock.lock();
    isUpdating_ = false;
    activity_ = {};
    lock.unlock();
    wake_();
    lock.lock();
  }
}

}  // namespace pectora::view
