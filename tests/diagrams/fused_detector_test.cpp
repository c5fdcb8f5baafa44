#include "diagrams/fused_detector.h"

#include <gmock/gmock.h>

#include "systems/foundation/setup_error.h"
#include "tests/diagrams/contact_rig.h"

namespace flinch {
namespace {

using enum ReactionMode;
using test::Bench;
using test::collision;
using test::RigExperiment;
using testing::HasSubstr;

/// Judges by the encoders alone; the simulated robot is as modelled.
FusedDetectorSettings by_the_encoders() {
  const ResidualErrors errors{.noise = 0.2, .speed = 0.05, .load = 0.01, .torque = 0.02, .friction = 0.1};
  return {.residuals = {{.estimator = "disturbance_filter",
                         .level = {.threshold = 8.0, .errors = errors},
                         .change = {.threshold = 8.0, .errors = errors}}},
          .tracking = {}};
}

RigExperiment with_fused_detector(const FusedDetectorSettings& settings) {
  RigExperiment experiment = collision(0.5);
  experiment.control.fused_detector = settings;
  experiment.control.stages.detectors.follow({"fused_detector", add_fused_detector});
  return experiment;
}

std::string complaint(const FusedDetectorSettings& settings) {
  try {
    const Bench rig(with_fused_detector(settings));
  } catch (const SetupError& error) {
    return error.problems().front();
  }
  return "";
}

TEST(FusedDetector, NoticesAContactBeforeAThresholdOfTheMomentumObserverDoes) {
  Bench plain(collision(0.5)), fused(with_fused_detector(by_the_encoders()));
  ASSERT_TRUE(plain.run_until(react, 3s));
  ASSERT_TRUE(fused.run_until(react, 3s));
  EXPECT_LT(fused.state().since, plain.state().since - 5ms);
  EXPECT_GT(fused.state().since, plain.state().since - 100ms) << "not before there was one";
}

TEST(FusedDetector, JudgesByTheLikelihoodRatioOfOnsetsWhereThatIsTheRule) {
  FusedDetectorSettings onsets = by_the_encoders();
  onsets.rule = ChangeRule::likelihood_ratio;
  EXPECT_THAT(complaint(onsets), HasSubstr("has no onset"));
  onsets.residuals[0].level.threshold = onsets.residuals[0].change.threshold = 1e6;
  onsets.residuals[0].onset = {.threshold = 8.0,
                               .course = {.prediction = {0.9, 0.0, 0.0, 0.0}, .innovation = 0.4}};
  Bench plain(collision(0.5)), fused(with_fused_detector(onsets));
  ASSERT_TRUE(plain.run_until(react, 3s));
  ASSERT_TRUE(fused.run_until(react, 3s));
  EXPECT_LT(fused.state().since, plain.state().since - 5ms);
  EXPECT_GT(fused.state().since, plain.state().since - 100ms) << "not before there was one";
}

TEST(FusedDetector, AddsAnEstimatorThatDoesNotRunAndUsesOneThatDoes) {
  RigExperiment both = with_fused_detector(by_the_encoders());
  for (const WrenchEstimator& stage : known_stages().estimators.all) {
    if (stage.name == "disturbance_filter") both.control.stages.estimators.add(stage);
  }
  Bench alone(with_fused_detector(by_the_encoders())), beside(both);
  ASSERT_TRUE(alone.run_until(react, 3s));
  ASSERT_TRUE(beside.run_until(react, 3s));
  EXPECT_EQ(alone.state().since, beside.state().since);
}

TEST(FusedDetector, TellsTheLoadsOfTheDrives) {
  Bench rig(with_fused_detector(by_the_encoders()));
  ASSERT_EQ(rig.control.others.loads.size(), 1U);
  EXPECT_EQ(rig.control.others.loads[0].name, "load_fused_detector");
  rig.run(300ms);
  EXPECT_TRUE(rig.context.get(rig.control.others.loads[0].port).valid);
}

TEST(FusedDetector, WithoutResidualsMayRunButNotBeFollowed) {
  EXPECT_THAT(complaint({}), HasSubstr("flinch calibrate thresholds finds them"));
  RigExperiment beside = collision(0.5);
  beside.control.stages.detectors.add({"fused_detector", add_fused_detector});
  Bench rig(beside);
  EXPECT_TRUE(rig.run_until(react, 3s)) << "by the contact detector";
}

TEST(FusedDetector, FollowsTheDisturbanceFilterBehindItsOwnPoles) {
  ContactControlSettings settings = collision(0.5).control;
  settings.disturbance_filter.pole = 250.0;
  EXPECT_EQ(tracking_of("disturbance_filter", settings).answer.filters, 3);
  EXPECT_EQ(tracking_of("disturbance_filter", settings).answer.rate, 250.0);
  EXPECT_EQ(tracking_of("imu_residual", settings).answer.filters, 0);
}

TEST(FusedDetector, TellsTheNearestNameOfAnEstimator) {
  FusedDetectorSettings misspelt = by_the_encoders();
  misspelt.residuals[0].estimator = "disturbence_filter";
  EXPECT_THAT(complaint(misspelt), HasSubstr("did you mean 'disturbance_filter'?"));
}

}  // namespace
}  // namespace flinch
