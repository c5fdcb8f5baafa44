// What a scenario expects of a run, and what is bad where it expects nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/verdict/verdict.h"
#include "systems/robot/configuration_space.h"
#include "tests/experiments/verdict/synthetic_run.h"

namespace flinch {
namespace {

using test::SyntheticRun;
using ::testing::ElementsAre;
using ::testing::StartsWith;

Verdict judged_by(const SyntheticRun& run, const Expectations& expected = {}) {
  return judge(run.recording(), ConfigurationSpace::Kind::planar_pose, expected, {});
}

TEST(Expectation, OfNothingIsMetByAQuietRun) {
  const Verdict verdict = judged_by(SyntheticRun(500));
  EXPECT_TRUE(verdict.good());
  EXPECT_NEAR(verdict.simulated, 0.5, 1e-12);
  EXPECT_EQ(verdict.fault, "");
}

TEST(Expectation, OfAContactNamesTheFirstBody) {
  SyntheticRun run(500);
  run.touch(BodyId::link1(0), 100, 150, 20.0).notice(110, 180);
  EXPECT_TRUE(judged_by(run, {.contact = "leg1_link1"}).good());
  EXPECT_THAT(judged_by(run, {.contact = "platform"}).failures,
              ElementsAre("leg1_link1 was touched instead of platform"));
  EXPECT_THAT(judged_by(run, {.contact = "none"}).failures,
              ElementsAre("there was a contact, though none was expected"));
  EXPECT_TRUE(judged_by(SyntheticRun(100), {.contact = "none"}).good());
  EXPECT_THAT(judged_by(SyntheticRun(100), {.contact = "platform"}).failures,
              ElementsAre("nothing was touched, though a contact with platform was expected"));
}

TEST(Expectation, OfADetectionTimeCountsFromTheOnset) {
  SyntheticRun run(500);
  run.touch(BodyId::platform(), 100, 150, 10.0).notice(110, 180);  // onset 0.1 ms after the tick at 99 ms
  EXPECT_TRUE(judged_by(run, {.detection_time = 0.0110}).good());
  EXPECT_THAT(judged_by(run, {.detection_time = 0.010}).failures,
              ElementsAre("the contact with platform was detected after 10.9 ms, later than 10.0 ms"));
}

TEST(Expectation, OfARemovalTimeCountsFromTheOnset) {
  SyntheticRun run(500);
  run.touch(BodyId::platform(), 100, 150, 10.0).notice(110, 180);  // from 99.1 ms until the tick at 151 ms
  EXPECT_TRUE(judged_by(run, {.removal_time = 0.052}).good());
  EXPECT_THAT(judged_by(run, {.removal_time = 0.05}).failures,
              ElementsAre("the contact with platform was over after 51.9 ms, later than 50.0 ms"));
  run.touch(BodyId::platform(), 151, 499, 10.0).notice(181, 499);
  EXPECT_THAT(
      judged_by(run, {.removal_time = 1.0}).failures,
      ElementsAre("the contact with platform was not over at the end, and should be after 1000.0 ms"));
}

TEST(Expectation, OfALastingForceIsABoundAfterTheTransientDuration) {
  SyntheticRun run(1500);
  run.touch(BodyId::platform(), 100, 590, 200.0).touch(BodyId::platform(), 610, 900, 90.0).notice(105, 900);
  EXPECT_TRUE(judged_by(run, {.lasting_force = 91.0}).good());
  EXPECT_THAT(judged_by(run, {.lasting_force = 50.0}).failures,
              ElementsAre("the force on platform lasted at 90 N, above 50 N"));
}

TEST(Expectation, OfNothingIsNotMetByAClampingThatLasts) {
  SyntheticRun run(1500);
  run.touch(BodyId::link2(0), 100, 1499, 80.0).notice(110, 1499);
  EXPECT_TRUE(judged_by(run).good()) << "a push against one body";
  run.at(115).contact.clamping = true;
  EXPECT_THAT(judged_by(run).failures,
              ElementsAre(StartsWith("the clamping leg1_clamping was not released")));
  EXPECT_TRUE(judged_by(run, {.lasting_force = 81.0}).good()) << "where the scenario says how hard it may be";
}

TEST(Expectation, OfErrorsIsABoundInItsUnit) {
  SyntheticRun run(100);
  run.at(10).estimate.wrench_in_base = Eigen::Vector3d(6.0, 0.0, 0.4);
  run.at(10).truth.pose[0] = 0.012;
  EXPECT_TRUE(judged_by(run, {.observer_error = 6.1, .observer_error_moment = 0.41, .tracking_error = 0.0121})
                  .good());
  EXPECT_THAT(
      judged_by(run, {.observer_error = 5.0, .observer_error_moment = 0.3, .tracking_error = 0.01}).failures,
      ElementsAre("the observer error reached 6 N, above 5 N",
                  "the observer error reached 0.4 Nm, above 0.3 Nm",
                  "the tracking error reached 12 mm, above 10 mm"));
}

}  // namespace
}  // namespace flinch
