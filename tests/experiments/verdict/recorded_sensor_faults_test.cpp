#include "experiments/verdict/recorded_sensor_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/verdict/verdict.h"
#include "systems/robot/configuration_space.h"
#include "tests/experiments/verdict/synthetic_run.h"

namespace flinch::test {
namespace {

using ::testing::ElementsAre;

constexpr ConfigurationSpace planar = ConfigurationSpace::Kind::planar_pose;

Verdict judged(const SyntheticRun& run) { return judge(run.recording(), planar, {}, {}); }

TEST(ImuFault, IsARemarkAndNoFailure) {
  SyntheticRun run(100);
  for (int k = 40; k < 100; ++k) run.at(k).plausibility.imu_doubt = ImuFault::biased;
  const Verdict verdict = judged(run);
  EXPECT_TRUE(verdict.good());
  EXPECT_EQ(verdict.imu_doubt, ImuFault::biased);
  EXPECT_THAT(verdict.remarks, ElementsAre("the IMU was left out from 0.040 s on: biased"));
  EXPECT_TRUE(judged(SyntheticRun(100)).remarks.empty());
}

TEST(ImuFault, IsToldWithTheShareOfTheRecordingThatItTook) {
  SyntheticRun run(100);
  EXPECT_EQ(imu_left_out(run.recording()).why, ImuFault::none);
  EXPECT_EQ(imu_left_out(run.recording()).share, 0.0);
  for (int k = 40; k < 100; ++k) run.at(k).plausibility.imu_doubt = ImuFault::biased;
  run.at(40).plausibility.imu_doubt = ImuFault::late;
  const Recording recording = run.recording();
  EXPECT_EQ(imu_left_out(recording).why, ImuFault::late);
  EXPECT_NEAR(imu_left_out(recording).share, 0.6, 1e-12);
  EXPECT_THAT(told_left_out(imu_left_out(recording)),
              ::testing::StartsWith("the IMU was left out of 60 % of the recording: "));
  EXPECT_EQ(told_left_out({}), "");
}

TEST(PassiveEncodersThatAreLost, AreARemarkAndNoFailure) {
  SyntheticRun run(100);
  for (int k = 60; k < 100; ++k) run.at(k).plausibility.passive_lost = true;
  const Verdict verdict = judged(run);
  EXPECT_TRUE(verdict.good());
  ASSERT_TRUE(verdict.passive_lost);
  EXPECT_NEAR(*verdict.passive_lost, 0.06, 1e-12);
  EXPECT_THAT(verdict.remarks,
              ElementsAre("there were no passive encoders from 0.060 s on: drives might turn "
                          "half as fast"));
}

}  // namespace
}  // namespace flinch::test
