#include "experiments/verdict/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "systems/foundation/setup_error.h"
#include "systems/robot/configuration_space.h"
#include "tests/experiments/verdict/synthetic_run.h"

namespace flinch {
namespace {

using test::SyntheticRun;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const BodyId platform = BodyId::platform();
constexpr ConfigurationSpace planar = ConfigurationSpace::Kind::planar_pose;

Verdict judged(const SyntheticRun& run, const Expectations& expected = {}, const ForceLimits& limits = {}) {
  return judge(run.recording(), planar, expected, limits);
}

Expectations contact_with(const std::string& body) {
  Expectations expected;
  expected.contact = body;
  return expected;
}

/// The only contact of a run.
ContactVerdict contact_of(const SyntheticRun& run, const ForceLimits& limits = {}) {
  const Verdict verdict = judged(run, {}, limits);
  EXPECT_EQ(verdict.contacts.size(), 1U);
  return verdict.contacts.empty() ? ContactVerdict() : verdict.contacts.front();
}

// ---------------------------------------------------------------- when a contact begins, is detected and
// ends

TEST(Contact, BeginsWhereTheForceRisesAboveOneNewtonBetweenSamples) {
  SyntheticRun run(500);
  run.touch(platform, 99, 99, 0.5).touch(platform, 100, 150, 4.5).notice(110, 200);
  EXPECT_NEAR(contact_of(run).onset, 0.099 + 0.001 * (1.0 - 0.5) / (4.5 - 0.5), 1e-12);
  EXPECT_NEAR(*contact_of(run).detected, 0.110, 1e-12);
}

TEST(Contact, OfOneNewtonIsNone) {
  SyntheticRun run(500);
  run.touch(platform, 100, 150, 1.0);
  EXPECT_THAT(judged(run).contacts, IsEmpty());
}

TEST(Contact, MayBeginWithTheRun) {
  SyntheticRun run(300);
  run.touch(platform, 0, 20, 10.0).notice(5, 30);
  EXPECT_EQ(contact_of(run).onset, 0.0);
  EXPECT_EQ(*contact_of(run).detected, 0.005);
}

TEST(Contact, IsNoticedUpToATenthOfASecondAfterItsEnd) {
  SyntheticRun soon(500), late(500);
  soon.touch(platform, 100, 110, 20.0).notice(208, 250);
  late.touch(platform, 100, 110, 20.0).notice(212, 250);
  EXPECT_NEAR(contact_of(soon).detected.value_or(-1.0), 0.208, 1e-12);
  EXPECT_EQ(contact_of(late).detected, std::nullopt);
  EXPECT_THAT(judged(late).failures, ElementsAre("the contact with platform was not detected",
                                                 "a contact was detected where there was none"));
}

TEST(Contact, IsNotNoticedByADetectorThatHadLatchedBefore) {
  SyntheticRun run(1000);
  run.touch(platform, 100, 150, 20.0).notice(110, 180).touch(BodyId::link2(1), 600, 650, 5.0);
  const Verdict verdict = judged(run);
  ASSERT_EQ(verdict.contacts.size(), 2U);
  EXPECT_TRUE(verdict.contacts[0].detected.has_value());
  EXPECT_FALSE(verdict.contacts[1].detected.has_value());
  EXPECT_THAT(verdict.failures, ElementsAre("the contact with leg2_link2 was not detected"));
}

TEST(Contact, IsRemovedOneSampleAfterTheLastForce) {
  SyntheticRun run(500);
  run.touch(platform, 100, 150, 20.0).notice(110, 180);
  EXPECT_NEAR(contact_of(run).removed.value_or(-1.0), 0.151, 1e-12);
}

TEST(Contact, ThatLastsToTheEndIsNotRemoved) {
  SyntheticRun touching(500), just_left(500);
  touching.touch(platform, 100, 499, 20.0).notice(110, 499);
  just_left.touch(platform, 100, 450, 20.0).notice(110, 499);
  EXPECT_EQ(contact_of(touching).removed, std::nullopt);
  EXPECT_EQ(contact_of(just_left).removed, std::nullopt);
}

TEST(Contact, GoesOnThroughInterruptionsOfLessThanATenthOfASecond) {
  SyntheticRun bounce(800);
  bounce.touch(platform, 100, 120, 20.0).touch(platform, 210, 230, 50.0).notice(110, 300);
  const ContactVerdict contact = contact_of(bounce);
  EXPECT_EQ(contact.peak_force, 50.0);
  EXPECT_NEAR(contact.removed.value_or(-1.0), 0.231, 1e-12);

  SyntheticRun twice(800);
  twice.touch(platform, 100, 120, 20.0).touch(platform, 230, 250, 50.0).notice(110, 300);
  EXPECT_EQ(judged(twice).contacts.size(), 2U);
}

// ---------------------------------------------------------------- what is touched, how fast, how hard

TEST(Contact, IsWithTheBodyOfThePeakForce) {
  SyntheticRun run(500);
  run.touch(platform, 100, 110, 20.0).touch(BodyId::link1(2), 111, 130, 30.0).notice(105, 200);
  EXPECT_EQ(contact_of(run).body, "leg3_link1");
  EXPECT_EQ(contact_of(run).peak_force, 30.0);
  EXPECT_NEAR(contact_of(run).peak_time, 0.111, 1e-12);
}

TEST(Contact, OfBothLinksIsClampingInTheirLeg) {
  SyntheticRun run(500);
  run.touch(BodyId::link2(0), 100, 110, 80.0).touch(BodyId::link1(0), 111, 120, 30.0).notice(105, 200);
  run.at(115).contact.clamping = true;
  EXPECT_EQ(contact_of(run).body, "leg1_clamping");
}

TEST(Contact, HasTheSpeedWithWhichThePlatformCame) {
  SyntheticRun run(500);
  run.touch(platform, 100, 110, 20.0).notice(105, 200);
  for (const int k : {97, 98, 99, 100}) run.at(k).truth.velocity = Eigen::Vector3d(0.6, 0.8, 9.0);
  run.at(98).truth.velocity *= 2.0;
  EXPECT_NEAR(contact_of(run).speed, 1.0, 1e-12);
  for (int k = 101; k < 200; ++k)
    run.at(k).truth.velocity = Eigen::Vector3d(-3.0, 0.0, 0.0);  // it springs back
  EXPECT_NEAR(contact_of(run).speed, 1.0, 1e-12);
  run.at(100).truth.velocity =
      Eigen::Vector3d(0.3, 0.4, 0.0);  // the force passes 1 N a twentieth into the tick
  EXPECT_NEAR(contact_of(run).speed, 1.0 - 0.5 / 20.0, 1e-12);
}

// ---------------------------------------------------------------- pushes

TEST(Push, IsAContactOfThePlatform) {
  SyntheticRun run(500);
  run.push(100, 150, {40.0, 0.0, 0.0}).notice(110, 180);
  const ContactVerdict contact = contact_of(run);
  EXPECT_TRUE(contact.is_push);
  EXPECT_EQ(contact.body, "platform");
  EXPECT_EQ(contact.peak_force, 40.0);
  EXPECT_NEAR(contact.onset, 0.099 + 0.001 / 40.0, 1e-12);
  EXPECT_NEAR(contact.detected.value_or(-1.0), 0.110, 1e-12);
  EXPECT_NEAR(contact.removed.value_or(-1.0), 0.151, 1e-12);
  EXPECT_TRUE(judged(run, contact_with("platform")).good());
}

TEST(Push, ByAMomentIsOneToo) {
  SyntheticRun run(500);
  run.push(100, 150, {0.0, 0.0, 2.0}).notice(110, 180);
  const ContactVerdict contact = contact_of(run);
  EXPECT_TRUE(contact.is_push);
  EXPECT_EQ(contact.peak_force, 0.0);
  EXPECT_NEAR(contact.onset, 0.099 + 0.001 * 0.1 / 2.0, 1e-12);
}

TEST(Push, MustBeNoticedUnlessItIsALoadToBear) {
  SyntheticRun run(500);
  run.push(100, 499, {40.0, 0.0, 0.0});
  EXPECT_THAT(judged(run).failures, ElementsAre("the contact with platform was not detected"));
  EXPECT_TRUE(judged(run, contact_with("none")).good());
}

TEST(Push, DoesNotHideATouchThatWasNotExpected) {
  SyntheticRun run(500);
  run.push(100, 150, {40.0, 0.0, 0.0}).touch(platform, 300, 310, 20.0).notice(110, 200).notice(305, 350);
  EXPECT_THAT(judged(run, contact_with("none")).failures,
              ElementsAre("there was a contact, though none was expected"));
}

// ---------------------------------------------------------------- what is left at the end

TEST(Contact, ThatIsNotOverAtTheEndIsRemarked) {
  SyntheticRun run(500);
  run.touch(BodyId::link2(0), 100, 499, 80.0).notice(110, 499);
  run.at(115).contact.clamping = true;
  EXPECT_TRUE(judged(run).good());
  EXPECT_THAT(judged(run).remarks, ElementsAre("the contact with leg1_clamping was not over at the end"));
}

TEST(ForceLimit, OfAShortContactIsTheTransientOne) {
  SyntheticRun run(800);
  run.touch(platform, 100, 140, 279.0).notice(105, 200);
  EXPECT_EQ(contact_of(run).limit, 280.0);
  EXPECT_EQ(contact_of(run).limit_name, "transient");
  EXPECT_EQ(contact_of(run).lasting_force, std::nullopt);
  EXPECT_TRUE(contact_of(run).within_limit);

  run.touch(platform, 120, 120, 281.0);
  EXPECT_FALSE(contact_of(run).within_limit);
  EXPECT_THAT(
      judged(run).failures,
      ElementsAre("the force on platform reached 281 N, above the transient limit of 280 N, for 1 ms in "
                  "all"));
  EXPECT_NEAR(contact_of(run).over_limit, 1e-3, 1e-12);
}

TEST(ForceLimit, OfWhatLastsIsTheQuasiStaticOne) {
  SyntheticRun run(1500);
  run.touch(platform, 100, 590, 200.0).touch(platform, 591, 900, 139.0).notice(105, 900);
  EXPECT_TRUE(contact_of(run).within_limit);
  EXPECT_EQ(contact_of(run).lasting_force, 139.0);
  EXPECT_EQ(contact_of(run).limit, 280.0);

  run.touch(platform, 700, 700, 141.0);
  EXPECT_FALSE(contact_of(run).within_limit);
  EXPECT_EQ(contact_of(run).limit, 140.0);
  EXPECT_THAT(
      judged(run).failures,
      ElementsAre("the force on platform stayed at 141 N, above the quasi-static limit of 140 N, for 1 ms "
                  "in all"));
}

TEST(ForceLimit, IsTheOneOfTheScenario) {
  SyntheticRun run(500);
  run.touch(platform, 100, 250, 60.0).notice(105, 200);
  EXPECT_FALSE(contact_of(run, {.transient = 50.0}).within_limit);
  EXPECT_FALSE(contact_of(run, {.quasi_static = 50.0, .transient_duration = 0.1}).within_limit);
  EXPECT_TRUE(contact_of(run, {.quasi_static = 50.0, .transient_duration = 0.2}).within_limit);
}

// ---------------------------------------------------------------- false detections

TEST(FalseDetection, IsOneWithNoTouchInTheLastTenthOfASecond) {
  EXPECT_EQ(judged(SyntheticRun(500).notice(100, 120)).false_detections, 1);
  SyntheticRun run(500);
  run.touch(platform, 100, 110, 5.0).notice(150, 180);
  EXPECT_EQ(judged(run).false_detections, 0);
  EXPECT_THAT(judged(SyntheticRun(500).notice(100, 120)).failures,
              ElementsAre("a contact was detected where there was none"));
}

TEST(FalseDetection, IsNotOneOfAnAppliedForceOrMoment) {
  for (const int component : {1, 2}) {
    SyntheticRun run(500);
    for (int k = 50; k < 200; ++k) run.at(k).truth.wrench_in_base[component] = 2.0;
    run.notice(150, 200);
    EXPECT_EQ(judged(run).false_detections, 0) << component;
  }
}

TEST(FalseDetection, CountsAgainAfterAReset) {
  SyntheticRun run(900);
  run.notice(100, 120);
  for (int k = 300; k < 900; ++k) run.at(k).detection.level = ContactLevel::none;
  run.notice(600, 650);
  EXPECT_EQ(judged(run).false_detections, 2);
}

// ---------------------------------------------------------------- errors

TEST(ObserverError, IsTheLargestComponentBeforeTheFirstTouch) {
  SyntheticRun run(500);
  run.touch(platform, 200, 250, 20.0).notice(210, 260);
  run.at(50).estimate.wrench_in_base = Eigen::Vector3d(1.0, -3.0, 0.1);
  run.at(60).estimate.wrench_in_base = Eigen::Vector3d(2.0, 2.0, -0.2);
  run.at(210).estimate.wrench_in_base = Eigen::Vector3d(90.0, 90.0, 9.0);
  run.at(400).estimate.wrench_in_base = Eigen::Vector3d(90.0, 90.0, 9.0);
  EXPECT_NEAR(judged(run).max_observer_error_force, 3.0, 1e-12);
  EXPECT_NEAR(judged(run).max_observer_error_moment, 0.2, 1e-12);
}

TEST(ObserverError, IsAgainstTheForceThatReallyActs) {
  SyntheticRun run(100);
  run.at(50).truth.wrench_in_base = Eigen::Vector3d(0.9, 0.0, 0.05);
  run.at(50).estimate.wrench_in_base = Eigen::Vector3d(1.0, 0.0, 0.05);
  EXPECT_NEAR(judged(run).max_observer_error_force, 0.1, 1e-12);
  EXPECT_NEAR(judged(run).max_observer_error_moment, 0.0, 1e-12);
}

TEST(ObserverError, LeavesOutEstimatesThatAreNotValid) {
  SyntheticRun run(100);
  run.at(5).estimate.wrench_in_base = Eigen::Vector3d(50.0, 50.0, 5.0);
  run.at(5).estimate.valid = false;
  run.at(6).estimate = WrenchEstimate();
  EXPECT_EQ(judged(run).max_observer_error_force, 0.0);
}

TEST(TrackingError, IsTheDistanceFromTheReferenceInTheNominalModeBeforeTheFirstTouch) {
  SyntheticRun run(500);
  run.touch(platform, 200, 250, 20.0).notice(210, 260);
  run.at(10).truth.pose = Eigen::Vector3d(0.003, -0.004, 0.02);
  run.at(20).truth.pose = Eigen::Vector3d(0.5, 0.0, 0.5);
  run.at(20).reaction.mode = ReactionMode::stopped;
  run.at(30).truth.pose = Eigen::Vector3d(0.5, 0.0, 0.5);
  run.at(30).reference = PlatformReference();
  run.at(300).truth.pose = Eigen::Vector3d(0.5, 0.0, 0.5);
  EXPECT_NEAR(judged(run).max_tracking_error, 0.005, 1e-12);
  EXPECT_NEAR(judged(run).max_orientation_error, 0.02, 1e-12);
}

TEST(TrackingError, WrapsTheAngle) {
  SyntheticRun run(100);
  run.at(10).truth.pose[2] = 3.1;
  run.at(10).reference.pose[2] = -3.1;
  EXPECT_NEAR(judged(run).max_orientation_error, 2.0 * 3.14159265358979 - 6.2, 1e-12);
}

TEST(LoopClosure, IsTheLargestMissOfTheRun) {
  SyntheticRun run(100);
  run.at(80).truth.loop_closure_error = 2e-9;
  EXPECT_EQ(judged(run).loop_closure, 2e-9);
  EXPECT_THAT(judged(run).failures, ElementsAre("the loop closure error reached 2e-09 m, above 1e-09 m"));
}

TEST(Fault, IsTheFirstOneOfTheGate) {
  SyntheticRun run(100);
  for (int k = 40; k < 100; ++k) run.at(k).gate.fault = GateFault::joint_speed;
  run.at(90).gate.fault = GateFault::torque_jump;
  const Verdict verdict = judged(run);
  EXPECT_FALSE(verdict.fault.empty());
  EXPECT_THAT(verdict.failures, ElementsAre("the torque gate closed: " + verdict.fault));

  SyntheticRun other(100);
  other.at(90).gate.fault = GateFault::torque_jump;
  EXPECT_NE(judged(other).fault, verdict.fault);
}

TEST(Gate, ThatNeverOpensMakesTheVerdictBad) {
  SyntheticRun run(100);
  for (int k = 0; k < 100; ++k) {
    run.at(k).gate.phase = GatePhase::waiting;
    run.at(k).gate.faults = fault_bit(GateFault::workspace_radius);
  }
  EXPECT_THAT(judged(run).failures, ElementsAre("the torque gate never opened: the platform is too far out"));
  run.at(50).gate.phase = GatePhase::open;
  EXPECT_TRUE(judged(run).good());
}

TEST(Verdict, NeedsEverySignalButThoseThatNotEveryRunHas) {
  const Recording whole = SyntheticRun(10).recording();
  const std::set<std::string> not_of_every_run = {
      "tick_timing", "joints_link",   "plausibility", "braking",        "classification", "reaction_task",
      "measures",    "true_measures", "limits",       "torque_command", "operator",       "target"};
  for (const Signal& left_out : whole.signals) {
    if (not_of_every_run.contains(left_out.path)) continue;
    Recording recording = whole;
    std::erase_if(recording.signals, [&](const Signal& signal) { return signal.path == left_out.path; });
    try {
      judge(recording, planar, {}, {});
      ADD_FAILURE() << "judged without " << left_out.path;
    } catch (const SetupError& error) {
      EXPECT_THAT(error.problems(),
                  ElementsAre(AllOf(HasSubstr("'" + left_out.path + "'"), HasSubstr("signal"))));
    }
  }
}

TEST(Verdict, OfAnEmptyRecordingIsGood) { EXPECT_TRUE(judged(SyntheticRun(0)).good()); }

// ---------------------------------------------------------------- why the gate closed

/// The gate closes at 300 ms for this fault, and stays so.
SyntheticRun closed_by(GateFault fault) {
  SyntheticRun run(500);
  for (int k = 300; k < 500; ++k) run.at(k).gate = {.phase = GatePhase::closed, .fault = fault};
  return run;
}

TEST(Fault, IsToldWithTheTicksThatWereMissedJustBefore) {
  SyntheticRun run = closed_by(GateFault::velocity_invalid);
  EXPECT_EQ(judged(run).fault, "no rates of the drives");
  run.at(100).timing.lost_periods = 7;  // long over
  run.at(299).timing.lost_periods = 2;
  run.at(350).timing.lost_periods = 5;  // too late to be the cause
  EXPECT_EQ(judged(run).fault, "no rates of the drives; 2 ticks were missed just before");
  EXPECT_THAT(judged(run).failures,
              ElementsAre("the torque gate closed: no rates of the drives; 2 ticks were missed just before"));
}

TEST(Fault, IsToldWithTheReadingsThatNobodySaw) {
  SyntheticRun run = closed_by(GateFault::joints_invalid);
  for (int k = 298; k < 500; ++k) run.at(k).joints_link.skipped = 3;
  EXPECT_EQ(judged(run).fault,
            "no usable angles of the drives; 3 readings of the joints came to no tick just before");
}

TEST(Fault, OfTheRobotItselfHasNoOtherCause) {
  SyntheticRun run = closed_by(GateFault::joint_speed);
  run.at(299).timing.lost_periods = 2;
  EXPECT_EQ(judged(run).fault, "a drive is too fast");
}

}  // namespace
}  // namespace flinch
