#include "experiments/scenario/scenario_thresholds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/scenario/scenario.h"
#include "experiments/scenario/scenario_calibrations.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string by_estimator =
    "control:\n"
    "  contact_detector:\n"
    "    by_estimator:\n"
    "      - {estimator: momentum_observer, reaction_force_N: 5, reaction_moment_Nm: 0.5}\n"
    "      - {estimator: imu_residual, reaction_force_N: 8}\n";
const std::string with_residuals = by_estimator +
                                   "  fused_detector:\n"
                                   "    smoothing_per_s: 300\n"
                                   "    residuals:\n"
                                   "      - estimator: imu_residual\n"
                                   "        level: {threshold: 7, noise_Nm: 0.25}\n"
                                   "        change: {threshold: 7.5, noise_Nm: 0.125}\n";

/// Matches a doubt by its sentence.
auto Tells(const ::testing::Matcher<std::string>& sentence) {
  return ::testing::Field("sentence", &CalibrationWarning::sentence, sentence);
}

class CalibratedThresholds : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& control) const {
    place.write("scenarios/" + name,
                "flinch_calibration: 1\nkind: thresholds\ndate: '2026-11-27'\n" + control);
  }
  Scenario read(const std::string& own = "{}", const std::string& files = "[{file: found.yaml}]") const {
    place.write("scenarios/own.yaml", "robot: ../robots/planar_3rrr.yaml\nduration_s: 1\ncalibrations: " +
                                          files + "\ncontrol: " + own + "\n");
    return read_scenario(place / "scenarios/own.yaml");
  }

  test::Workplace place;
};

TEST_F(CalibratedThresholds, HoldForTheEstimatorsThatAFileNames) {
  write("found.yaml", with_residuals);
  const Scenario scenario = read();
  const auto& thresholds = scenario.control.reaction_thresholds;
  EXPECT_EQ(thresholds.at("momentum_observer").force, 5.0);
  EXPECT_EQ(thresholds.at("momentum_observer").moment, 0.5);
  EXPECT_EQ(thresholds.at("imu_residual").moment, std::nullopt);
  EXPECT_EQ(scenario.control.fused_detector.tracking.smoothing, 300.0);
  ASSERT_EQ(scenario.control.fused_detector.residuals.size(), 1U);
  EXPECT_EQ(scenario.control.fused_detector.residuals.front().change.threshold, 7.5);
  EXPECT_THAT(scenario.warnings, IsEmpty());
}

TEST_F(CalibratedThresholds, GiveWayToWhatTheScenarioSaysOfAnEstimator) {
  write("found.yaml", with_residuals);
  const auto thresholds =
      read("{contact_detector: {by_estimator: [{estimator: imu_residual, reaction_force_N: 9}]}}")
          .control.reaction_thresholds;
  EXPECT_EQ(thresholds.at("imu_residual").force, 9.0);
  EXPECT_EQ(thresholds.at("momentum_observer").force, 5.0);
}

TEST_F(CalibratedThresholds, OfAMomentStayWhereTheScenarioSaysOnlyTheForce) {
  write("found.yaml", by_estimator);
  const Scenario scenario =
      read("{contact_detector: {by_estimator: [{estimator: momentum_observer, reaction_force_N: 9}]}}");
  const ReactionThreshold reaction = scenario.control.detector_of("momentum_observer").reaction;
  EXPECT_EQ(reaction.force, 9.0);
  EXPECT_EQ(reaction.moment, 0.5);
  EXPECT_THAT(scenario.warnings, IsEmpty());
}

TEST_F(CalibratedThresholds, WithoutAMomentHaveThatOfTheScenario) {
  write("found.yaml", by_estimator);
  const Scenario scenario =
      read("{estimators: [imu_residual], contact_detector: {reaction_moment_Nm: 0.75}}");
  EXPECT_EQ(scenario.control.detector_of("imu_residual").reaction.moment, 0.75);
  EXPECT_THAT(scenario.warnings, IsEmpty());
}

TEST_F(CalibratedThresholds, CountBeforeThoseThatTheScenarioHasForAllEstimatorsAndThatIsSaid) {
  write("found.yaml", by_estimator);
  const Scenario scenario = read(
      "{estimators: [momentum_observer, imu_residual, disturbance_filter], contact_detector: "
      "{reaction_force_N: 4, reaction_moment_Nm: 0.4, by_estimator: [{estimator: momentum_observer, "
      "reaction_force_N: 9}]}}");
  EXPECT_EQ(scenario.control.detector_of("imu_residual").reaction.force, 8.0);
  EXPECT_EQ(scenario.control.detector_of("disturbance_filter").reaction.force, 4.0);
  EXPECT_THAT(scenario.warnings,
              ElementsAre(Tells(HasSubstr("control.contact_detector.reaction_force does not count for "
                                          "imu_residual, calibrated by themselves")),
                          Tells(HasSubstr("control.contact_detector.reaction_moment does not count for "
                                          "momentum_observer, calibrated by themselves"))));
}

TEST_F(CalibratedThresholds, GiveWayToTheResidualsOfTheScenarioAsAWhole) {
  write("found.yaml", with_residuals);
  const auto residuals =
      read(
          "{fused_detector: {residuals: [{estimator: disturbance_filter, level: {threshold: 8, "
          "noise_Nm: 1}, change: {threshold: 9, noise_Nm: 1}}]}}")
          .control.fused_detector.residuals;
  ASSERT_EQ(residuals.size(), 1U);
  EXPECT_EQ(residuals.front().estimator, "disturbance_filter");
}

TEST_F(CalibratedThresholds, WithoutAnOnsetDoNotServeTheLikelihoodRatioOfTheScenario) {
  write("found.yaml", with_residuals);
  EXPECT_THAT(test::problems_of([&] { read("{fused_detector: {rule: likelihood_ratio}}"); }),
              ElementsAre(HasSubstr("own.yaml:4: control.fused_detector.rule: is likelihood_ratio, which")));
}

TEST_F(CalibratedThresholds, OfTwoFilesAreThoseOfTheLastAndThatIsSaid) {
  write("found.yaml", with_residuals);
  write("later.yaml",
        "control: {contact_detector: {by_estimator: [{estimator: imu_residual, reaction_force_N: 6}]}}\n");
  const Scenario scenario = read("{}", "[{file: found.yaml}, {file: later.yaml}]");
  EXPECT_EQ(scenario.control.reaction_thresholds.at("imu_residual").force, 6.0);
  EXPECT_EQ(scenario.control.reaction_thresholds.at("momentum_observer").force, 5.0);
  EXPECT_THAT(
      scenario.warnings,
      ElementsAre(Tells("later.yaml: replaces what found.yaml says of reaction_force_N of imu_residual")));
}

TEST_F(CalibratedThresholds, OfTwoFilesDoNotReplaceOneAnotherWhereOneHasTheForceAndOneTheMoment) {
  write("found.yaml", by_estimator);
  write("later.yaml",
        "control: {contact_detector: {by_estimator: [{estimator: imu_residual, reaction_moment_Nm: 2}]}}\n");
  const Scenario scenario = read("{}", "[{file: found.yaml}, {file: later.yaml}]");
  EXPECT_THAT(scenario.warnings, IsEmpty());
  EXPECT_EQ(scenario.control.detector_of("imu_residual").reaction.force, 8.0);
  EXPECT_EQ(scenario.control.detector_of("imu_residual").reaction.moment, 2.0);
}

TEST_F(CalibratedThresholds, OfTheTrackingReplaceThoseBeforeThemAndThatIsSaid) {
  write("found.yaml", with_residuals);
  write("later.yaml", "control: {fused_detector: {smoothing_per_s: 200}}\n");
  EXPECT_THAT(
      read("{}", "[{file: found.yaml}, {file: later.yaml}]").warnings,
      ElementsAre(Tells("later.yaml: replaces what found.yaml says of fused_detector.smoothing_per_s")));
}

TEST_F(CalibratedThresholds, OfTwoFilesDoNotReplaceThoseOfOtherEstimators) {
  write("found.yaml", with_residuals);
  write("later.yaml",
        "control: {contact_detector: {by_estimator: [{estimator: disturbance_filter, reaction_force_N: "
        "6}]}}\n");
  EXPECT_THAT(read("{}", "[{file: found.yaml}, {file: later.yaml}]").warnings, IsEmpty());
}

TEST_F(CalibratedThresholds, OfFilesWithOneNameAreToldByTheirPlaceAmongThem) {
  write("found.yaml", with_residuals);
  write("anew/found.yaml", with_residuals);
  EXPECT_THAT(
      read("{}", "[{file: found.yaml}, {file: anew/found.yaml}]").warnings,
      ElementsAre(Tells("found.yaml (calibration 2): replaces what found.yaml (calibration 1) says of "
                        "fused_detector.smoothing_per_s, fused_detector.residuals, "
                        "reaction_force_N of momentum_observer and 2 more")));
}

TEST_F(CalibratedThresholds, ThatAreNoGoodAreToldByTheirOwnFile) {
  write("found.yaml", by_estimator + "      - {estimator: imu_residue, reaction_force_N: -1}\n  tasks: {}\n");
  EXPECT_THAT(
      test::problems_of([&] { read("{impedence: 1}"); }),
      ElementsAre(HasSubstr("own.yaml:4: control.impedence"),
                  HasSubstr("found.yaml:9: control.contact_detector.by_estimator[2].reaction_force_N"),
                  HasSubstr("found.yaml:9: control.contact_detector.by_estimator[2].estimator: is "
                            "'imu_residue', which is no estimator; did you mean 'imu_residual'"),
                  HasSubstr("found.yaml:10: control.tasks: is not a known key")));
}

TEST_F(CalibratedThresholds, MayBeOnesForEachComponent) {
  write("found.yaml",
        "control: {contact_detector: {by_estimator: [{estimator: momentum_observer, reaction_force_N: [5, "
        "70]}]}}\n");
  const Scenario scenario = read("{contact_detector: {reaction_force_N: [8, 9], reaction_moment_Nm: [2]}}");
  EXPECT_EQ(scenario.control.contact_detector.reaction.force, ComponentBounds({8.0, 9.0}));
  const ContactDetectorSettings own = scenario.control.detector_of("momentum_observer");
  EXPECT_EQ(own.reaction.force, ComponentBounds({5.0, 70.0}));
  EXPECT_EQ(own.reaction.moment, 2.0);
  EXPECT_EQ(own.hard.force, 70.0) << "never below that of the reaction";
  EXPECT_THAT(
      test::problems_of([&] { read("{contact_detector: {reaction_force_N: [8, 9, 10]}}"); }),
      ElementsAre(HasSubstr("own.yaml:4: control.contact_detector.reaction_force_N: is a list of 3; it "
                            "must be a list of 2 numbers")));
  EXPECT_THAT(
      test::problems_of([&] { read("{contact_detector: {reaction_force_N: [8, 90]}}"); }),
      ElementsAre(HasSubstr("hard_force: is 60 N; it must be at least reaction_force, which is 90 N")));
}

TEST_F(CalibratedThresholds, AreCheckedWithoutARobot) {
  const auto checked = [&](const std::string& control) {
    write("found.yaml", control);
    check_thresholds(read_parameter_file(place / "scenarios/found.yaml"));
  };
  checked(with_residuals);
  std::string of_pushing_drives = with_residuals;
  for (std::size_t at = 0; (at = of_pushing_drives.find("noise_Nm", at)) != std::string::npos;)
    of_pushing_drives.replace(at, 8, "noise_N");
  checked(of_pushing_drives);
  checked("control: {contact_detector: {reaction_force_N: 80}}\n");  // another file may have harder hard ones
  EXPECT_THAT(test::problems_of([&] { checked("control: 5\n"); }),
              ElementsAre(HasSubstr("found.yaml:4: control")));
  EXPECT_THAT(test::problems_of([&] { checked(of_pushing_drives + "        chnge: {}\n"); }),
              ElementsAre(HasSubstr("residuals[0].chnge: is not a known key; did you mean 'change'")))
      << "nothing is said of the unit of the drives";
}

TEST_F(CalibratedThresholds, OfOneEstimatorStandOnce) {
  write("found.yaml", by_estimator + "      - {estimator: imu_residual, reaction_force_N: 7}\n");
  EXPECT_THAT(test::problems_of([&] { read(); }), ElementsAre(HasSubstr("as that of an entry before it")));
}

}  // namespace
}  // namespace flinch
