#include "systems/framework/duration_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "systems/framework/random.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

DurationSummary summary_of(const std::vector<Time>& durations) {
  DurationHistogram histogram;
  for (const Time duration : durations) histogram.add(duration);
  return histogram.summary().value();
}

/// The smallest of `sorted` that at least the share `q` does not exceed.
Time exact_quantile(const std::vector<Time>& sorted, double q) {
  return sorted[static_cast<std::size_t>(std::ceil(q * static_cast<double>(sorted.size()))) - 1];
}

void expect_never_too_small_and_at_most_a_32th_too_large(Time found, Time exact) {
  EXPECT_GE(found, exact);
  EXPECT_LE(found, exact + exact / 32);
}

// ---------------------------------------------------------------- laws

TEST(DurationHistogram, AgreesWithSortingUpToTheWidthOfItsBins) {
  RandomGenerator random(1);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Time> durations(static_cast<std::size_t>(random.uniform(1, 3000)));
    const double octaves = random.uniform(1, 36);
    for (Time& duration : durations) duration = Time(std::llround(std::exp2(random.uniform(0, octaves)) - 1));
    const DurationSummary found = summary_of(durations);

    std::sort(durations.begin(), durations.end());
    const Time sum = std::accumulate(durations.begin(), durations.end(), Time::zero());
    EXPECT_EQ(found.count, std::ssize(durations));
    EXPECT_EQ(found.min, durations.front());
    EXPECT_EQ(found.mean, sum / std::ssize(durations));
    EXPECT_EQ(found.max, durations.back());
    expect_never_too_small_and_at_most_a_32th_too_large(found.p50, exact_quantile(durations, 0.5));
    expect_never_too_small_and_at_most_a_32th_too_large(found.p99, exact_quantile(durations, 0.99));
    expect_never_too_small_and_at_most_a_32th_too_large(found.p99_9, exact_quantile(durations, 0.999));
  }
}

// ---------------------------------------------------------------- examples

TEST(DurationHistogram, HasNothingToSayOfNothing) { EXPECT_FALSE(DurationHistogram().summary().has_value()); }

TEST(DurationHistogram, IsExactBelow64Nanoseconds) {
  std::vector<Time> durations;
  for (int ns = 1; ns <= 60; ++ns) durations.emplace_back(ns);
  EXPECT_EQ(summary_of(durations).p50, Time(30));
}

TEST(DurationHistogram, SeesOneSlowTickInAThousand) {
  std::vector<Time> durations(1000, Time(100us));
  durations[500] = 20ms;
  EXPECT_LE(summary_of(durations).p99_9, Time(104us));
  durations[700] = 20ms;
  EXPECT_EQ(summary_of(durations).p99_9, Time(20ms));
}

TEST(DurationHistogram, KeepsTheLongestExactlyHoweverLong) {
  const DurationSummary summary = summary_of({Time(-5), Time(1h)});
  EXPECT_EQ(summary.min, Time(0));
  EXPECT_EQ(summary.p99, Time(1h));
  EXPECT_EQ(summary.max, Time(1h));
}

TEST(DurationHistogram, NeverAllocates) {
  const test::AllocationCounter counter;
  DurationHistogram histogram;
  for (int k = 0; k < 1000; ++k) histogram.add(Time(k * k));
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace flinch
