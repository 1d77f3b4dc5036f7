#include "kernel/physics/workers.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <thread>

namespace pectora {
namespace {

int threadCount = std::max(1, int(std::thread::hardware_concurrency()));
std::unique_ptr<tbb::global_control> limit;   // lets TBB have more threads than the machine has cores
std::unique_ptr<tbb::task_arena> arena;

}  // namespace

void setThreads(int count) {
  threadCount = std::max(1, count);
  limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, std::size_t(threadCount));
  arena = std::make_unique<tbb::task_arena>(threadCount);
}

int threads() { return threadCount; }

void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body) {
  if (threadCount == 1 || count < 2) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  if (!arena) setThreads(threadCount);
  arena->execute([&] { tbb::parallel_for(std::size_t(0), count, body, tbb::auto_partitioner()); });
}

}  // namespace pectora
