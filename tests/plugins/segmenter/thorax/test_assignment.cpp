#include "plugins/segmenter/thorax/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

using pectora::thorax::assign;

namespace {

/// Cost of an assignment with `gate / 2` for everything left alone.
double costOf(const std::vector<std::vector<double>>& cost, const std::vector<int>& match, double gate) {
  double sum = 0;
  std::size_t paired = 0;
  for (std::size_t r = 0; r < match.size(); ++r)
    if (match[r] >= 0) sum += cost[r][match[r]], ++paired;
  return sum + gate / 2 * double(cost.size() + cost[0].size() - 2 * paired);
}

/// The least cost by trying all injections of rows into columns or nothing.
double bestByForce(const std::vector<std::vector<double>>& cost, double gate) {
  const int rows = int(cost.size()), columns = int(cost[0].size());
  std::vector<int> slots(columns + rows, -1);
  std::iota(slots.begin(), slots.begin() + columns, 0);
  std::sort(slots.begin(), slots.end());
  double best = 1e300;
  do {
    std::vector<int> match(slots.begin(), slots.begin() + rows);
    bool isAllowed = true;
    for (int r = 0; r < rows; ++r) isAllowed = isAllowed && (match[r] < 0 || cost[r][match[r]] < gate);
    if (isAllowed) best = std::min(best, costOf(cost, match, gate));
  } while (std::next_permutation(slots.begin(), slots.end()));
  return best;
}

TEST(Assignment, IsAsCheapAsTheBestOfAllAssignments) {
  unsigned state = 7;
  const auto random = [&] { return double((state = state * 1664525u + 1013904223u) >> 8) / (1 << 24); };
  for (int trial = 0; trial < 60; ++trial) {
    const int rows = 1 + trial % 4, columns = 1 + trial / 4 % 4;
    std::vector<std::vector<double>> cost(rows, std::vector<double>(columns));
    for (auto& row : cost)
      for (double& c : row) c = 10 * random();
    EXPECT_NEAR(costOf(cost, assign(cost, 6), 6), bestByForce(cost, 6), 1e-9) << trial;
  }
}

TEST(Assignment, PrefersTwoFairPairsToOneGoodAndOneBad) {
  EXPECT_EQ(assign({{1, 2}, {2, 9}}, 100), (std::vector<int>{1, 0}));
}

TEST(Assignment, NeverPairsBeyondTheGate) {
  EXPECT_EQ(assign({{5, 50}, {60, 70}}, 10), (std::vector<int>{0, -1}));
}

TEST(Assignment, OfNothingIsNothing) {
  EXPECT_TRUE(assign({}, 1).empty());
  EXPECT_EQ(assign({{}, {}}, 1), (std::vector<int>{-1, -1}));
}

}  // namespace
