#include "kernel/physics/workers.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <thread>

namespace pectora {
namespace {

int threadCount = std::max(1, int(std::thread::hardware_concurrency()));
std::unique_ptr<tbb::task_arena> arena;

}  // namespace

void setThreads(int count) {
  threadCount = std::max(1, count);
  arena = std::make_unique<tbb::task_arena>(threadCount);
}

int threads() { return threadCount; }

void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body) {
  if (threadCount == 1 || count < 2) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  if (!arena) setThreads(threadCount);
  arena->execute([&] { tbb::parallel_for(std::size_t(0), count, body, tbb::simple_partitioner()); });
}

}  // namespace pectora
