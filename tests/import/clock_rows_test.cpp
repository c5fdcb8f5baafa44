#include "import/clock_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "import/log_file.h"
#include "import/log_track.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::int64_t ms = 1'000'000;

std::vector<std::int64_t> regular(std::size_t rows, std::int64_t step) {
  std::vector<std::int64_t> instants;
  for (std::size_t k = 0; k < rows; ++k) instants.push_back(static_cast<std::int64_t>(k) * step);
  return instants;
}

TEST(ClockRows, LeavesOutRowsThatRepeatAndGoBack) {
  const ClockRows rows = clock_rows({0, 1, 2, 2, 4, 3, 5, no_instant, 6, 900, 7, 8});
  EXPECT_THAT(rows.instants, ElementsAre(0, 1, 2, 4, 5, 6, 7, 8));
  EXPECT_EQ(rows.repeated, 1U);
  EXPECT_EQ(rows.out_of_order, 2U);
  EXPECT_EQ(rows.without_time, 1U);
  EXPECT_EQ(rows.phases.size(), 1U);
}

TEST(ClockRows, TakesThePhaseThatIsWantedOrTheLongest) {
  std::vector<std::int64_t> instants = regular(20, ms);
  for (const std::int64_t instant : regular(30, ms)) instants.push_back(instant);
  EXPECT_EQ(clock_rows(instants).instants.size(), 30U);
  EXPECT_EQ(clock_rows(instants, 1).instants.size(), 20U);
  EXPECT_THAT(
      told_rows(clock_rows(instants), "t"),
      ElementsAre(HasSubstr(
          "the time 't' begins 2 times; taken was phase 2 of 1 (from row 1, 0.01 s), 2 (from row 21")));
  EXPECT_THAT(test::problems_of([&] { clock_rows(instants, 3); }),
              ElementsAre(HasSubstr("there is no phase 3")));
}

/// Stamps that jitter, of which some are lost, of every rate between 90 and 8000 Hz.
TEST(ClockRate, IsThatOfTheLog) {
  std::mt19937 random(1);
  for (const double rate : {90.0, 96.6, 125.0, 642.0, 1000.0, 2000.0, 8000.0}) {
    const double period = 1e9 / rate;
    std::normal_distribution<double> jitter(0.0, 0.3 * period);
    std::bernoulli_distribution lost(0.02);
    std::vector<std::int64_t> clean, jittered;
    double latest = -1.0;
    for (int k = 0; k < 5000; ++k) {
      clean.push_back(std::llround(k * period));
      const double stamp = k * period + jitter(random);
      if (lost(random) || stamp <= latest) continue;
      jittered.push_back(std::llround(latest = stamp));
    }
    EXPECT_NEAR(clock_rate(clean).rate(), rate, 1e-3 * rate);
    EXPECT_NEAR(clock_rate(jittered).rate(), rate, 0.03 * rate);
  }
  EXPECT_EQ(clock_rate(regular(100, ms)).period, ms);
}

TEST(ClockRate, CountsGapsAndRowsThatAreMissing) {
  std::vector<std::int64_t> instants = regular(100, ms);
  instants.erase(instants.begin() + 70, instants.begin() + 90);
  instants.erase(instants.begin() + 50);
  const ClockRate rate = clock_rate(instants);
  EXPECT_EQ(rate.gaps, 1U);
  EXPECT_NEAR(rate.longest_gap, 0.021, 1e-9);
  EXPECT_NEAR(rate.first_gap, 0.069, 1e-9);
  EXPECT_EQ(rate.bridged, 1U);
}

double value_at(const LogTrack& track, std::int64_t instant) {
  return track.at(instant, track.row_before(instant, 0));
}

TEST(ATrack, IsInterpolatedAcrossRowsThatAreMissingButNotWhereTheLogHasNoNumber) {
  auto instants = std::make_shared<std::vector<std::int64_t>>(regular(40, ms));
  instants->erase(instants->begin() + 20);
  std::vector<double> values;
  for (const std::int64_t instant : *instants) values.push_back(1e-6 * static_cast<double>(instant));
  values[5] = std::nan("");
  const LogTrack track = log_track(instants, values);
  EXPECT_EQ(value_at(track, 3 * ms), 3.0);
  EXPECT_DOUBLE_EQ(value_at(track, 3 * ms + ms / 4), 3.25);
  EXPECT_DOUBLE_EQ(value_at(track, 20 * ms), 20.0);
  EXPECT_TRUE(std::isnan(value_at(track, 5 * ms)));
  EXPECT_TRUE(std::isnan(value_at(track, 5 * ms - 1)));
  EXPECT_TRUE(std::isnan(value_at(track, -1)));
  EXPECT_TRUE(std::isnan(value_at(track, 39 * ms + 1)));
}

TEST(ATrack, OfMostlyEmptyCellsHasARateOfItsOwn) {
  const auto instants = std::make_shared<std::vector<std::int64_t>>(regular(60, ms));
  std::vector<double> values(60, std::nan(""));
  for (std::size_t k = 0; k < 60; k += 5) values[k] = static_cast<double>(k);
  for (const std::size_t lost : {20U, 25U, 30U}) values[lost] = std::nan("");
  const LogTrack track = log_track(instants, values);
  EXPECT_DOUBLE_EQ(value_at(track, 7 * ms), 7.0);
  EXPECT_TRUE(std::isnan(value_at(track, 27 * ms)));  // a gap of four of its rows
}

TEST(ATrack, IsUnwrapped) {
  std::vector<double> degrees = {170.0, 179.0, -178.0, std::nan(""), -170.0, 179.0};
  const Unwrapped done = unwrap(degrees, 360.0);
  EXPECT_EQ(done.steps, 2U);
  EXPECT_EQ(done.first_row, 2U);
  EXPECT_EQ(degrees[2], 182.0);
  EXPECT_EQ(degrees[4], 190.0);
  EXPECT_EQ(degrees[5], 179.0);
}

}  // namespace
}  // namespace flinch
