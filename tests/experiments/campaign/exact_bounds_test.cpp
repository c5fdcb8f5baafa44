#include "experiments/campaign/exact_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>
#include <vector>

namespace flinch {
namespace {

TEST(UpperRate, IsThatOfNoEventsInClosedForm) {
  for (const double hours : {0.5, 3.0, 100.0})
    EXPECT_NEAR(garwood_upper(0, hours), -std::log(0.05) / hours, 1e-9);
}

TEST(UpperRate, IsHalfTheQuantileOfChiSquare) {
  EXPECT_NEAR(garwood_upper(3, 1.0), 7.7537, 1e-4);  // chi-square of 8 degrees of freedom, 0.95: 15.5073
  EXPECT_NEAR(garwood_upper(10, 1.0), 16.9622, 1e-4);
}

TEST(UpperRate, CoversTheTrueRateAsOftenAsItSays) {
  std::mt19937_64 random(1);
  std::poisson_distribution<int> events(4.0);
  int covered = 0;
  constexpr int trials = 20000;
  for (int i = 0; i < trials; ++i)
    covered += garwood_upper(static_cast<std::size_t>(events(random)), 1.0) >= 4.0 ? 1 : 0;
  EXPECT_GE(covered, static_cast<int>(0.945 * trials));
}

TEST(UpperRate, IsInfiniteWithoutExposure) { EXPECT_TRUE(std::isinf(garwood_upper(0, 0.0))); }

TEST(LowerRate, IsHalfTheQuantileOfChiSquareToo) {
  EXPECT_NEAR(lower_rate(3, 1.0), 0.817691, 1e-6);  // chi-square of 6 degrees of freedom, 0.05: 1.635383
  EXPECT_NEAR(lower_rate(1, 2.0), -std::log(0.95) / 2.0, 1e-12);
}

TEST(LowerRate, IsZeroWithoutEvents) { EXPECT_EQ(lower_rate(0, 3.0), 0.0); }

TEST(UpperShare, IsThatOfNoneAndOfAllButOneInClosedForm) {
  EXPECT_NEAR(clopper_pearson_upper(0, 100), 1.0 - std::pow(0.05, 0.01), 1e-12);
  EXPECT_NEAR(clopper_pearson_upper(9, 10), std::pow(0.95, 0.1), 1e-12);
}

TEST(UpperShare, IsOneWhereAllOrNothingHappened) {
  EXPECT_EQ(clopper_pearson_upper(5, 5), 1.0);
  EXPECT_EQ(clopper_pearson_upper(0, 0), 1.0);
}

TEST(ConfidenceBelow, IsTheInverseOfTheUpperShare) {
  for (const std::size_t events : {0U, 3U, 40U}) {
    for (const double confidence : {0.6, 0.95, 0.999})
      EXPECT_NEAR(confidence_below(events, 60, clopper_pearson_upper(events, 60, confidence)), confidence,
                  1e-9);
  }
  EXPECT_EQ(confidence_below(7, 7, 0.9), 0.0);
}

// Ranks of tables of the sign test's interval for a median: 2 and 9 of 10, 6 and 15 of 20, 40 and 61 of 100.
TEST(RanksAroundQuantile, AreThoseOfTablesForTheMedian) {
  for (const auto& [count, lower, upper] :
       {std::tuple(6U, 1U, 6U), {10U, 2U, 9U}, {20U, 6U, 15U}, {100U, 40U, 61U}}) {
    const RankBounds ranks = ranks_around_quantile(count, 0.5);
    EXPECT_EQ(ranks.lower, lower);
    EXPECT_EQ(ranks.upper, upper);
  }
  EXPECT_FALSE(ranks_around_quantile(5, 0.5).lower);  // the chance that all five lie above it is 3 %
}

TEST(RanksAroundQuantile, HoldTheQuantileAsOftenAsTheySay) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> value(0.0, 1.0);
  for (const double share : {0.5, 0.9}) {
    const RankBounds ranks = ranks_around_quantile(60, share);
    ASSERT_TRUE(ranks.lower && ranks.upper);
    int held = 0;
    constexpr int trials = 20000;
    for (int i = 0; i < trials; ++i) {
      std::vector<double> sample(60);
      for (double& each : sample) each = value(random);
      std::sort(sample.begin(), sample.end());
      held += sample[*ranks.lower - 1] <= share && share <= sample[*ranks.upper - 1] ? 1 : 0;
    }
    EXPECT_GE(held, static_cast<int>(0.945 * trials));
    EXPECT_LE(held, static_cast<int>(0.985 * trials));  // no wider than whole ranks make it
  }
}

TEST(RanksAroundQuantile, LeaveOpenWhatASmallSampleCannotBound) {
  const RankBounds ranks = ranks_around_quantile(20, 0.9);
  EXPECT_TRUE(ranks.lower);
  EXPECT_FALSE(ranks.upper);  // all of 20 lie below it with 12 %
}

// Sizes of samples without an event and with one, of tables of tolerance limits: 29 and 46 for 90 %, 59 and
// 93 for 95 %, at a confidence of 95 %.
TEST(ToleratedEvents, AreThoseOfToleranceLimits) {
  EXPECT_EQ(trials_without_event(0.1), 29U);
  EXPECT_EQ(trials_without_event(0.05), 59U);
  EXPECT_EQ(tolerated_events(28, 0.1), std::nullopt);
  EXPECT_EQ(tolerated_events(45, 0.1), 0U);
  EXPECT_EQ(tolerated_events(46, 0.1), 1U);
  EXPECT_EQ(tolerated_events(92, 0.05), 0U);
  EXPECT_EQ(tolerated_events(93, 0.05), 1U);
}

TEST(UpperShare, HoldsForManyTrials) {  // no sum under- or overflows
  EXPECT_NEAR(clopper_pearson_upper(0, 1'000'000), -std::log(0.05) / 1e6, 1e-11);
  EXPECT_GT(clopper_pearson_upper(5000, 10'000), 0.5);
  EXPECT_LT(clopper_pearson_upper(5000, 10'000), 0.51);
}

}  // namespace
}  // namespace flinch
