#include "calibration/threshold_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "systems/foundation/setup_error.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The largest of 500 samples of noise, as often as `stretches`.
std::vector<double> peaks_of_noise(std::mt19937_64& random, std::size_t stretches, double deviation) {
  std::normal_distribution<double> noise(0.0, deviation);
  std::vector<double> peaks(stretches);
  for (double& peak : peaks) {
    for (int i = 0; i < 500; ++i) peak = std::max(peak, std::abs(noise(random)));
  }
  return peaks;
}

EstimatorPeaks noise(std::mt19937_64& random, std::size_t stretches) {
  return {"observer", peaks_of_noise(random, stretches, 1.0), peaks_of_noise(random, stretches, 0.1), {}};
}

std::string complaint(std::size_t stretches, const ThresholdGoal& goal) {
  std::mt19937_64 random(1);
  try {
    calibrate_thresholds({noise(random, stretches)}, goal);
  } catch (const SetupError& error) {
    return error.problems().front();
  }
  return "";
}

TEST(Thresholds, OfAPowerAreRootsOfThoseOfPeaksRaisedToIt) {
  std::mt19937_64 random(1);
  const std::vector<double> peaks = peaks_of_noise(random, 180, 1.0);
  std::vector<double> squares = peaks;
  for (double& peak : squares) peak *= peak;
  const CalibratedThreshold of_squares = calibrated_threshold(squares, 1e-5, {});
  const CalibratedThreshold threshold = calibrated_threshold(peaks, 1e-5, {}, 2.0);
  EXPECT_NEAR(threshold.value, std::sqrt(of_squares.value), 1e-12);
  EXPECT_NEAR(threshold.best_guess, std::sqrt(of_squares.best_guess), 1e-12);
  EXPECT_EQ(threshold.largest, *std::max_element(peaks.begin(), peaks.end()));
  EXPECT_LT(threshold.value, calibrated_threshold(peaks, 1e-5, {}).value);
}

TEST(Thresholds, KeepTheRateOfFalseAlarmsThatWasAsked) {
  // Nine of ten calibrations of 90 s keep the rate in 50 hours of noise of the same kind.
  std::mt19937_64 random(7);
  const ThresholdGoal goal{.false_alarms_per_hour = 10.0};
  constexpr std::size_t trials = 20, check_stretches = 5 * 7200;
  int kept = 0;
  const EstimatorPeaks later = noise(random, check_stretches);
  for (std::size_t trial = 0; trial < trials; ++trial) {
    const EstimatorThresholds thresholds = calibrate_thresholds({noise(random, 180)}, goal).front();
    std::size_t alarms = 0;
    for (std::size_t i = 0; i < check_stretches; ++i) {
      alarms +=
          later.force[i] >= thresholds.force.value || later.moment[i] >= thresholds.moment.value ? 1U : 0U;
    }
    kept += static_cast<double>(alarms) <= 10.0 * 5.0 ? 1 : 0;
  }
  EXPECT_GE(kept, 18);
}

TEST(Thresholds, ComeFromErrorsOnly) {
  std::mt19937_64 random(1);
  for (const double scale : {0.0, 1e-300, 1e-27, 1e-12}) {
    for (const bool of_moment : {false, true}) {
      for (const bool by_component : {false, true}) {
        EstimatorPeaks peaks = noise(random, 200);
        for (double& peak : of_moment ? peaks.moment : peaks.force) peak *= scale;
        EXPECT_THAT(test::problems_of([&] { calibrate_thresholds({peaks}, {.by_component = by_component}); }),
                    ElementsAre(HasSubstr("these recordings hold no errors, as where readings are constant")))
            << scale;
      }
    }
  }
}

TEST(Thresholds, AreHigherForFewerFalseAlarmsAndForMoreConfidence) {
  std::mt19937_64 random(1);
  const std::vector<EstimatorPeaks> peaks = {noise(random, 200)};
  const auto force = [&](double rate, double confidence) {
    return calibrate_thresholds(peaks, {.false_alarms_per_hour = rate, .confidence = confidence})
        .front()
        .force;
  };
  EXPECT_GT(force(0.5, 0.95).value, force(50.0, 0.95).value);
  EXPECT_GT(force(0.5, 0.95).value, force(0.5, 0.6).value);
  EXPECT_GT(force(0.5, 0.95).value, force(0.5, 0.95).best_guess);
  EXPECT_EQ(force(0.5, 0.95).papers_rule, 2.0 * force(0.5, 0.95).largest);
}

TEST(Thresholds, OfARobotThatDoesNotTurnSpendAllAlarmsOnForce) {
  std::mt19937_64 random(1);
  EstimatorPeaks peaks = noise(random, 200);
  const double beside_moment = calibrate_thresholds({peaks}, {}).front().force.value;
  peaks.moment.clear();
  const EstimatorThresholds alone = calibrate_thresholds({peaks}, {}).front();
  EXPECT_LT(alone.force.value, beside_moment);
  EXPECT_EQ(alone.moment.value, 0.0);
}

TEST(Thresholds, ByComponentShareTheAlarmsAndKeepTheRate) {
  // Two components of noise, one three times as large as the other, in 50 hours.
  std::mt19937_64 random(3);
  const ThresholdGoal goal{.false_alarms_per_hour = 10.0, .by_component = true};
  constexpr int trials = 20, check_stretches = 5 * 7200;
  const auto peaks_of = [&](std::size_t stretches) {
    EstimatorPeaks peaks{"observer", {}, {}, {}};
    peaks.components = {peaks_of_noise(random, stretches, 1.0), peaks_of_noise(random, stretches, 3.0)};
    for (std::size_t i = 0; i < stretches; ++i)
      peaks.force.push_back(std::max(peaks.components[0][i], peaks.components[1][i]));
    return peaks;
  };
  const EstimatorPeaks later = peaks_of(check_stretches);
  int kept = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const EstimatorThresholds found = calibrate_thresholds({peaks_of(180)}, goal).front();
    ASSERT_EQ(found.components.size(), 2U);
    EXPECT_LT(found.components[0].value, 0.5 * found.force.value) << "one for both is that of the larger";
    double alarms = 0.0;
    for (std::size_t i = 0; i < later.force.size(); ++i) {
      alarms += later.components[0][i] > found.components[0].value ||
                        later.components[1][i] > found.components[1].value
                    ? 1.0
                    : 0.0;
    }
    const double hours = check_stretches * to_seconds(goal.stretch) / 3600.0;
    kept += alarms / hours <= goal.false_alarms_per_hour ? 1 : 0;
  }
  EXPECT_GE(kept, trials - 3);
  EXPECT_TRUE(calibrate_thresholds({peaks_of(180)}, {}).front().components.empty());
}

TEST(ARecordingThatIsTooShort, IsRefusedWithWhatIsNeeded) {
  EXPECT_THAT(complaint(13, {.false_alarms_per_hour = 10.0}),
              HasSubstr("observer: 6.5 s of motion with valid estimates are recorded; 7.0 s"));
  EXPECT_THAT(complaint(14, {}), HasSubstr("7.2 s are needed for 0.5"));
  EXPECT_EQ(complaint(15, {}), "");
  EXPECT_THAT(complaint(200, {.false_alarms_per_hour = 0.01}), HasSubstr("360.0 s are needed for 0.01"));
}

TEST(AnEstimatorThatWasSeenTooShort, IsLeftOutAndTheOthersAreNot) {
  std::mt19937_64 random(5);
  const auto peaks = [&random](const char* name, std::size_t stretches) {
    EstimatorPeaks of{name, peaks_of_noise(random, stretches, 1.0), {}, {}};
    of.components = {of.force};
    return of;
  };
  std::vector<std::string> left_out;
  const auto found = calibrate_thresholds({peaks("seen", 100), peaks("unseen", 5)}, {}, left_out);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().estimator, "seen");
  EXPECT_THAT(left_out, ::testing::ElementsAre(HasSubstr("unseen: 2.5 s of motion")));
  EXPECT_THAT(test::problems_of([&] { calibrate_thresholds({peaks("unseen", 5)}, {}, left_out); }),
              ::testing::ElementsAre(HasSubstr("unseen: 2.5 s of motion")));
}

TEST(PeaksOfSeveralRecordings, ArePooledByEstimator) {
  const auto all = pooled({{{"a", {1.0}, {0.1}, {{1.0}, {0.1}}}, {"b", {2.0}, {0.2}, {}}},
                           {{"a", {3.0}, {0.3}, {{3.0}, {0.3}}}, {"b", {4.0}, {0.4}, {}}}});
  ASSERT_EQ(all.size(), 2U);
  EXPECT_THAT(all[0].force, ::testing::ElementsAre(1.0, 3.0));
  EXPECT_THAT(all[1].moment, ::testing::ElementsAre(0.2, 0.4));
  EXPECT_THAT(all[0].components,
              ::testing::ElementsAre(::testing::ElementsAre(1.0, 3.0), ::testing::ElementsAre(0.1, 0.3)));
  EXPECT_THROW(pooled({{{"a", {1.0}, {}, {}}}, {{"b", {1.0}, {}, {}}}}), SetupError);
}

}  // namespace
}  // namespace flinch
