#include "kernel/physics/workers.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

using namespace pectora;

TEST(ParallelFor, CallsEachIndexOnce) {
  std::vector<std::atomic<int>> calls(1000);
  parallelFor(calls.size(), [&](std::size_t i) { ++calls[i]; });
  for (const auto& count : calls) EXPECT_EQ(count, 1);
}

TEST(ParallelFor, HandsOnTheExceptionOfABody) {
  EXPECT_THROW(parallelFor(100, [](std::size_t i) { if (i == 50) throw std::runtime_error("fifty"); }), std::runtime_error);
}
