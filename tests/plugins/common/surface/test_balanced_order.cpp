#include "plugins/common/surface/balanced_order.h"

#include "kernel/physics/workers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

using namespace pectora;

namespace {

// Points in a flat box, longest along x; some of them the same.
std::vector<TreeItem> items(std::size_t count) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<TreeItem> all(count);
  for (std::size_t i = 0; i < count; ++i) {
    all[i] = {{100 * unit(random), 40 * unit(random), unit(random)}, std::int32_t(i)};
    if (i % 7 == 1) std::copy_n(all[i - 1].center, 3, all[i].center);
  }
  return all;
}

}  // namespace

TEST(BalancedOrder, HoldsEveryItemOnceAndHalvesAlongTheLongestSide) {
  for (const std::size_t count : {1u, 8u, 9u, 1000u, 30000u}) {
    const std::vector<TreeItem> all = items(count);
    const std::vector<std::int32_t> order = balancedOrder(all, 8);
    std::vector<std::int32_t> sorted = order, every(count);
    std::sort(sorted.begin(), sorted.end());
    std::iota(every.begin(), every.end(), 0);
    ASSERT_EQ(sorted, every);
    if (count <= 8) continue;
    std::size_t middle = 8;
    while (2 * middle < count) middle *= 2;
    const auto x = [&](std::size_t i) { return all[order[i]].center[0]; };
    float below = 0, above = 100;
    for (std::size_t i = 0; i < count; ++i) (i < middle ? below : above) = i < middle ? std::max(below, x(i)) : std::min(above, x(i));
    EXPECT_LE(below, above) << count;
  }
}

TEST(BalancedOrder, IsTheSameForAnyNumberOfThreads) {
  const int before = threads();
  std::vector<std::vector<std::int32_t>> orders;
  for (int count : {1, 2, 3}) {
    setThreads(count);
    orders.push_back(balancedOrder(items(50000), 8));
  }
  setThreads(before);
  EXPECT_EQ(orders[0], orders[1]);
  EXPECT_EQ(orders[0], orders[2]);
}

TEST(BalancedOrder, TakesItemsThatAllLieInOnePlace) {
  std::vector<TreeItem> all(100);
  for (int i = 0; i < 100; ++i) all[i] = {{1, 2, 3}, i};
  std::vector<std::int32_t> order = balancedOrder(all, 8);
  std::sort(order.begin(), order.end());
  EXPECT_EQ(order.back(), 99);
  EXPECT_EQ(std::unique(order.begin(), order.end()), order.end());
}
