#include "calibration/contact_free_peaks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/platform_motion.h"
#include "tests/experiments/verdict/synthetic_run.h"

namespace flinch {
namespace {

using test::SyntheticRun;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr ConfigurationSpace space = ConfigurationSpace::Kind::planar_pose;

Recording named(Recording recording) {
  recording.attributes["control.estimator"] = "observer";
  return recording;
}

/// As a robot on the bus records it: of the platform is known what the controller measured.
Recording without_witness(Recording recording) {
  std::erase_if(recording.signals,
                [](const Signal& signal) { return signal.path == "truth" || signal.path == "contact"; });
  PlatformMotion measured;
  measured.status = PlatformMotion::Status::valid;
  measured.pose = measured.velocity = Eigen::Vector3d::Zero();
  Signal motion{"motion", row_layout<PlatformMotion>(), {}};
  motion.rows.resize(recording.samples() * motion.layout.numbers);
  for (std::size_t k = 0; k < recording.samples(); ++k)
    write_row(measured, motion.rows.data() + k * motion.layout.numbers);
  recording.signals.push_back(motion);
  return recording;
}

std::string complaint(const Recording& recording) {
  try {
    contact_free_peaks(recording, space, 10ms);
  } catch (const SetupError& error) {
    return error.problems().front();
  }
  return "";
}

TEST(Peaks, AreTheLargestComponentOfEachStretch) {
  SyntheticRun run(35);
  run.at(3).estimate.wrench_in_base = Eigen::Vector3d(-2.0, 1.0, 0.3);
  run.at(9).estimate.wrench_in_base = Eigen::Vector3d(1.0, 1.5, -0.4);
  run.at(10).estimate.wrench_in_base = Eigen::Vector3d(0.0, 5.0, 0.0);
  const auto peaks = contact_free_peaks(named(run.recording()), space, 10ms);
  ASSERT_EQ(peaks.size(), 1U);
  EXPECT_EQ(peaks[0].estimator, "observer");
  EXPECT_THAT(peaks[0].force, ElementsAre(2.0, 5.0, 0.0)) << "the last stretch is not whole";
  EXPECT_THAT(peaks[0].moment, ElementsAre(0.4, 0.0, 0.0));
  EXPECT_THAT(peaks[0].components, ElementsAre(ElementsAre(2.0, 0.0, 0.0), ElementsAre(1.5, 5.0, 0.0),
                                               ElementsAre(0.4, 0.0, 0.0)));
}

TEST(Peaks, LeaveOutStretchesWithoutAnEstimateOrOutsideTheNominalMotion) {
  SyntheticRun run(40);
  run.at(5).estimate.valid = false;
  run.at(5).estimate.wrench_in_base = Eigen::Vector3d(100.0, 0.0, 0.0);
  run.at(39).reaction.mode = ReactionMode::hold;
  const auto peaks = contact_free_peaks(named(run.recording()), space, 10ms);
  EXPECT_EQ(peaks[0].force.size(), 3U) << "6 to 15, 16 to 25, 26 to 35";
}

TEST(Peaks, LeaveOutWhereTheRobotStandsStillButNotWhereItWaitsForAMoment) {
  SyntheticRun run(3000);
  for (int k = 0; k < 3000; ++k) {
    PlatformReference& reference = run.at(k).reference;
    reference.valid = true;
    const bool moves = k < 100 || (k >= 500 && k < 600);
    reference.velocity = Eigen::Vector3d(moves ? 0.1 : 0.0, 0.0, 0.0);
    reference.acceleration = Eigen::Vector3d::Zero();
  }
  const auto peaks = contact_free_peaks(named(run.recording()), space, 10ms);
  EXPECT_NEAR(static_cast<double>(peaks[0].force.size()), 160.0, 1.0) << "until 1 s after it has arrived";
}

/// Of a robot that nobody watched: it would raise the thresholds.
TEST(APeakThatNobodyNoted, IsRefusedWithItsTimeWhereNobodyWatched) {
  SyntheticRun run(500);
  for (int k = 0; k < 500; ++k)
    run.at(k).estimate.wrench_in_base = Eigen::Vector3d(1.0 + 0.5 * std::sin(k), 0.1, 0.01 * std::cos(k));
  run.at(333).estimate.wrench_in_base[1] = 40.0;
  EXPECT_EQ(complaint(named(run.recording())), "") << "somebody watched, so it was none";
  EXPECT_THAT(complaint(named(without_witness(run.recording()))),
              HasSubstr("observer: a force of 40 N after 0.3 s is no error like those of the other 49"));
}

TEST(ARecordingWithContact, IsRefusedWithItsTime) {
  EXPECT_THAT(complaint(named(SyntheticRun(40).touch(BodyId::platform(), 12, 14, 5.0).recording())),
              HasSubstr("touched or pushed the robot at 0.012 s"));
  EXPECT_THAT(complaint(named(SyntheticRun(40).push(20, 22, {0.0, 0.0, 0.5}).recording())),
              HasSubstr("touched or pushed the robot at 0.020 s"));
}

TEST(ARecordingWithoutWitness, IsRefusedWhereTheRobotNoticedSomething) {
  const Recording recording = named(SyntheticRun(40).notice(8, 9).recording());
  EXPECT_EQ(complaint(recording), "") << "the simulation knows that there was nothing";
  EXPECT_THAT(complaint(without_witness(recording)), HasSubstr("the robot detected a contact at 0.008 s"));
}

TEST(ARecordingWithoutNames, IsRefused) {
  EXPECT_THAT(complaint(SyntheticRun(40).recording()), HasSubstr("no estimates of named estimators"));
}

}  // namespace
}  // namespace flinch
