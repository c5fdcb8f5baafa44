// What a robot of the rig makes of sensors and drives that lie: a slice of the campaign.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "tests/fault/lies/false_alarms.h"
#include "tests/fault/lies/lie_cases.h"

namespace flinch::test {
namespace {

TEST(Lies, ThatOncePassedAreNamedAndAnsweredByBrakes) {
  const std::vector<LieCase> cases = lies_that_once_passed();
  fmt::print("{}", table_head());
  for (const LieOutcome& outcome : try_all(cases)) {
    fmt::print("{}", line_of(outcome));
    EXPECT_EQ(problem_with(outcome), "") << outcome.lie;
    EXPECT_TRUE(outcome.named) << outcome.lie;
  }
}

TEST(Lies, OfOneDriveAtOneSpeedAreAnsweredInTime) {
  std::vector<LieCase> cases;
  for (const std::string& lie : lies_of_a_drive(2)) {
    if (lie != "drive2:scaled:0") cases.push_back({{.speed = 0.6, .brakes = 5ms}, lie});
  }
  for (const LieOutcome& outcome : try_all(cases)) EXPECT_EQ(problem_with(outcome), "") << line_of(outcome);
}

/// Of the five-bar and the hexapod, sizes as their drives are fast and strong.
TEST(Lies, OfOtherRobotsAreAnsweredInTime) {
  std::vector<LieCase> cases;
  for (const auto& [robot, passive] : {std::pair("five_bar", true), std::pair("hexapod_6ups", false)}) {
    LieScene scene{.robot = robot, .speed = 0.3, .passive_encoders = passive, .brakes = 5ms};
    for (const std::string lie : {"drive1:off", "drive1:reversed", "drive1:scaled:-1", "currents:stuck",
                                  "encoder1:reversed", "encoder1:stuck", "status:stuck"})
      cases.push_back({scene, lie});
    scene.moment = LieMoment::stop;
    cases.push_back({scene, "drive1:scaled:-1"});
  }
  for (const LieOutcome& outcome : try_all(cases)) {
    EXPECT_TRUE(outcome.began) << line_of(outcome);
    EXPECT_EQ(problem_with(outcome), "") << line_of(outcome);
  }
}

/// Of a drive that turns round in a contact little can be told before it has given more energy than the thing
/// that is touched has taken.
TEST(Lies, OfADriveThatTurnsRoundEndEarlyInEveryMoment) {
  std::vector<LieCase> cases;
  for (const LieMoment moment :
       {LieMoment::motion, LieMoment::stop, LieMoment::contact, LieMoment::reaction}) {
    for (int drive = 1; drive <= 3; ++drive) {
      const LieScene scene{.speed = 0.5, .direction_deg = 180.0, .brakes = 5ms, .moment = moment};
      cases.push_back({scene, "drive" + std::to_string(drive) + ":scaled:-1"});
    }
  }
  for (const LieOutcome& outcome : try_all(cases)) {
    EXPECT_TRUE(outcome.named) << line_of(outcome);
    EXPECT_LT(outcome.excess, 0.5) << line_of(outcome);
    EXPECT_LT(outcome.force, 1.2) << line_of(outcome);
  }
}

TEST(Lies, OfATorqueThatIsMissingAreNamedByTheEnergyThatTheRobotGets) {
  const LieScene scene{.speed = 0.6, .brakes = 5ms};
  const LieOutcome outcome = try_lie(scene, "drive2:scaled:0", honest_run(scene));
  EXPECT_EQ(outcome.fault, GateFault::torque_contradicted) << line_of(outcome);
  EXPECT_LT(outcome.excess, 0.5) << line_of(outcome);
}

TEST(Honesty, IsNotDoubtedInMotionNorInContact) {
  const std::string folder = FLINCH_SOURCE_DIR "/tests/campaign/lies/";
  for (const MountedSensors sensors :
       {MountedSensors{}, MountedSensors{.passive_encoders = false, .imu = false}}) {
    for (const auto& [file, runs] : {std::pair("motion.yaml", 2), std::pair("contacts.yaml", 40)}) {
      const Margins margins = margins_of_campaign(folder + file, static_cast<std::size_t>(runs), sensors);
      EXPECT_TRUE(margins.alarms.empty()) << file << ": " << margins.table();
      EXPECT_GT(margins.seconds, 30.0) << "the robots move";
      for (const double ratio : margins.largest) EXPECT_LT(ratio, 0.9) << margins.table();
    }
  }
}

TEST(LostPassiveEncoders, StopNoRobotThatIsSlow) {
  const LieScene slow{.speed = 0.3, .brakes = 5ms};
  EXPECT_FALSE(try_lie(slow, "passive_encoders:off", honest_run(slow)).alarm.has_value());
}

}  // namespace
}  // namespace flinch::test
