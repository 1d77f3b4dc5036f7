#include "kernel/value/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pectora;

TEST(Statistics, AgreeWithFiguresByHand) {
  const DistanceStatistics s = statistics({-2, 0, 2, 4});
  EXPECT_EQ(s.count, 4u);
  EXPECT_DOUBLE_EQ(s.mean, 1);
  EXPECT_DOUBLE_EQ(s.sd, std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(s.rms, std::sqrt(6.0));
  EXPECT_DOUBLE_EQ(s.min, -2);
  EXPECT_DOUBLE_EQ(s.max, 4);
  EXPECT_DOUBLE_EQ(s.median, 1);
  EXPECT_DOUBLE_EQ(s.p95, 3.7);  // of 0, 2, 2, 4 at rank 2.85
}

TEST(Statistics, SatisfyRmsSquaredIsMeanSquaredPlusSdSquared) {
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back(std::sin(i * 0.7) * 5 + 3);
  const DistanceStatistics s = statistics(values);
  EXPECT_NEAR(s.rms * s.rms, s.mean * s.mean + s.sd * s.sd, 1e-10);
}

TEST(Statistics, OfNothingAreZero) { EXPECT_EQ(statistics({}).count, 0u); }

TEST(Skill, IsOneForAPerfectPredictionAndZeroForNoChange) {
  Comparison c;
  c.pit = statistics({0, 0, 0});
  c.baselinePit = statistics({5, 5, 5});
  EXPECT_DOUBLE_EQ(c.skill(), 1);
  c.pit = c.baselinePit;
  EXPECT_DOUBLE_EQ(c.skill(), 0);
  c.baselinePit = {};
  EXPECT_TRUE(std::isnan(c.skill()));
}
