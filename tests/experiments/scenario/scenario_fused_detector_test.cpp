#include "experiments/scenario/scenario_fused_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/scenario/scenario.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A residual of the fused detector, in one line; `onset` is its section, or nothing.
FusedDetectorSettings read(const test::Workplace& place, const std::string& keys, const std::string& onset) {
  place.write("scenarios/own.yaml",
              "robot: ../robots/planar_3rrr.yaml\nduration_s: 0.25\ncontrol:\n  fused_detector:\n" + keys +
                  "    residuals:\n"
                  "      - estimator: imu_residual\n"
                  "        level: {threshold: 7, noise_Nm: 0.25}\n"
                  "        change: {threshold: 7.5, noise_Nm: 0.125}\n" +
                  onset);
  return read_scenario(place / "scenarios/own.yaml").control.fused_detector;
}

const char* const by_ratio = "    rule: likelihood_ratio\n";
const char* const an_onset =
    "        onset: {threshold: 6, innovation: 0.5, prediction: [0.5, 0.25, 0.125, -0.5]}\n";

TEST(TheFusedDetectorOfAScenario, JudgesByChiSquareUnlessToldOtherwise) {
  const test::Workplace place;
  EXPECT_EQ(read(place, "", "").rule, ChangeRule::chi_square);
  EXPECT_FALSE(read(place, "", "").residuals.front().onset);
  EXPECT_EQ(read(place, "", an_onset).rule, ChangeRule::chi_square);
}

TEST(TheFusedDetectorOfAScenario, JudgesByTheLikelihoodRatioOfOnsets) {
  const test::Workplace place;
  const FusedDetectorSettings settings = read(place, by_ratio, an_onset);
  EXPECT_EQ(settings.rule, ChangeRule::likelihood_ratio);
  const OnsetThreshold onset = settings.residuals.front().onset.value();
  EXPECT_EQ(onset.threshold, 6.0);
  EXPECT_EQ(onset.course.innovation, 0.5);
  EXPECT_THAT(onset.course.prediction, ElementsAre(0.5, 0.25, 0.125, -0.5));
}

TEST(TheFusedDetectorOfAScenario, NeedsAnOnsetForTheLikelihoodRatio) {
  const test::Workplace place;
  EXPECT_THAT(
      test::problems_of([&] { read(place, by_ratio, ""); }),
      ElementsAre(HasSubstr("own.yaml:5: control.fused_detector.rule: is likelihood_ratio, which needs "
                            "an onset, and the residual of imu_residual has none")));
  EXPECT_THAT(test::problems_of([&] { read(place, by_ratio, "        onset: {threshold: 6}\n"); }),
              ElementsAre(HasSubstr("innovation"), HasSubstr("prediction")));
}

TEST(TheFusedDetectorOfAScenario, JudgesByWhatIsSmoothedWhereTheFileSaysHow) {
  const test::Workplace place;
  EXPECT_FALSE(read(place, "", "").residuals.front().smoothed);
  const FusedDetectorSettings settings =
      read(place, "    smoothing_per_s: 100\n",
           "        smoothed: {threshold: 8, noise_Nm: 0.0625, rest_Nm: 0.5, acceleration_rad_per_s2: 3}\n");
  EXPECT_EQ(settings.tracking.smoothing, 100.0);
  EXPECT_EQ(settings.residuals.front().smoothed->threshold, 8.0);
  EXPECT_EQ(settings.residuals.front().smoothed->errors.rest, 0.5);
  EXPECT_EQ(settings.residuals.front().smoothed->errors.acceleration, 3.0);
  EXPECT_THAT(test::problems_of([&] { read(place, "", "        smoothed: {threshold: 8}\n"); }),
              ElementsAre(HasSubstr("smoothed.noise_Nm: is missing")));
}

}  // namespace
}  // namespace flinch
