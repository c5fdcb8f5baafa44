#include "calibration/thresholds_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "calibration/threshold_calibration.h"
#include "experiments/scenario/scenario.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const ThresholdFindings some = {
    .goal = {},
    .estimators = {{.estimator = "observer",
                    .stretches = 180,
                    .force = {6.25, 5.5, 4.0, 8.0},
                    .moment = {0.5, 0.4, 0.3, 0.6}},
                   {.estimator = "filter", .stretches = 180, .force = {7.5, 7.0, 5.0, 10.0}, .moment = {}}},
    .residuals = {},
    .recordings = {{"a/run.h5", "0123abcd"}},
    .robot = {"planar.yaml", "89ab"},
    .assumed = {{.name = "drives.torque_constant_Nm_per_A[0]", .value = 6.5, .unit = "Nm/A"}}};

ThresholdFindings with_a_residual(bool drives_turn) {
  ThresholdFindings found = some;
  found.drives_turn = drives_turn;
  found.residuals = {
      {.estimator = "filter",
       .stretches = 180,
       .level = {{.noise = 0.25, .speed = 0.5, .load = 0.0, .torque = 0.125, .friction = 0.75, .lag = 0.5},
                 0.25,
                 0.0,
                 {8.0}},
       .change = {{.noise = 0.5, .speed = 0.25, .load = 0.0625, .torque = 0.5, .friction = 1.0, .lag = 0.25},
                  0.125,
                  0.0,
                  {9.5}},
       .smoothed = {{.noise = 0.0625,
                     .speed = 0.5,
                     .load = 0.0,
                     .torque = 0.25,
                     .friction = 0.5,
                     .lag = 0.125,
                     .rest = 0.375,
                     .acceleration = 1.5},
                    0.0625,
                    0.03125,
                    {7.5}},
       .onset = CalibratedOnset{{.prediction = {0.5, 0.25, 0.125, -0.0625}, .innovation = 0.375}, {6.5}}}};
  return found;
}

TEST(TheTable, ShowsThresholdsBesideThePapersRule) {
  const std::string table = thresholds_table(some);
  EXPECT_THAT(table, HasSubstr("2 x max"));
  EXPECT_THAT(table, HasSubstr("from 90.0 s of motion without contact"));
  EXPECT_THAT(table, HasSubstr("6.25"));
}

TEST(TheObject, HasEveryNumber) {
  const auto json = nlohmann::json::parse(thresholds_json(some));
  EXPECT_EQ(json["false_alarms_per_h"], 0.5);
  EXPECT_EQ(json["thresholds"][0]["force_N"]["value"], 6.25);
  EXPECT_EQ(json["thresholds"][0]["moment_Nm"]["papers_rule"], 0.6);
  EXPECT_TRUE(json["thresholds"][1]["moment_Nm"].is_null());
}

TEST(TheParameterFile, IsWhatAScenarioTakes) {
  EXPECT_EQ(std::regex_replace(thresholds_yaml(some, "2026-11-22"), std::regex(R"(flinch \d+\.\d+\.\d+)"),
                               "flinch V"),
            "# Written by flinch calibrate. A scenario takes it over with\n"
            "#   calibrations: [{file: NAME}]\n"
            "flinch_calibration: 1\n"
            "kind: thresholds\n"
            "date: '2026-11-22'\n"
            "robot: {file: 'planar.yaml', sha256: '89ab'}\n"
            "recordings:\n"
            "  - {file: 'a/run.h5', sha256: '0123abcd'}\n"
            "assumed:\n"
            "  - {name: 'drives.torque_constant_Nm_per_A[0]', value: 6.5, unit: 'Nm/A', identifiable: true}\n"
            "# Thresholds made by flinch V:\n"
            "#   for 0.5 false alarms an hour of each estimator, kept with a confidence of 95 % in\n"
            "#   motion like that of the recordings\n"
            "# Largest of each, and 2 x that, [RAL25] V-C:\n"
            "#   observer, 90.0 s: 4 N, 8 N; 0.3 Nm, 0.6 Nm\n"
            "#   filter, 90.0 s: 5 N, 10 N\n"
            "control:\n"
            "  contact_detector:\n"
            "    by_estimator:\n"
            "      - {estimator: observer, reaction_force_N: 6.25, reaction_moment_Nm: 0.5}\n"
            "      - {estimator: filter, reaction_force_N: 7.5}\n");
}

TEST(TheParameterFile, TellsHowFarTheWrenchOfTheClassifiersIsOffWhereThatIsKnown) {
  ThresholdFindings found = some;
  EXPECT_THAT(thresholds_yaml(found, "2026-11-22"), Not(HasSubstr("isolation")));
  found.drive_deviations = Eigen::Vector2d(0.125, 2.5);
  EXPECT_THAT(thresholds_yaml(found, "2026-11-22"),
              HasSubstr("\n  isolation: {drive_deviation_Nm: [0.125, 2.5]}\n"));
  EXPECT_THAT(thresholds_table(found), HasSubstr("deviation at each drive [0.125, 2.5] Nm\n"));
  EXPECT_THAT(thresholds_json(found), HasSubstr("\"drive_deviations\":[0.125,2.5]"));
}

TEST(Thresholds, ByComponentAreListsWhereThereAreSeveral) {
  ThresholdFindings found = some;
  found.estimators = {some.estimators.front()};
  found.estimators.front().components = {{5.5, 5.0, 4.0, 8.0}, {7.5, 5.0, 4.0, 8.0}, {0.25, 0.2, 0.1, 0.2}};
  EXPECT_THAT(thresholds_yaml(found, "2026-11-22"),
              HasSubstr("- {estimator: observer, reaction_force_N: [5.5, 7.5], reaction_moment_Nm: 0.25}\n"));
  const std::string table = thresholds_table(found);
  EXPECT_THAT(table, AllOf(HasSubstr("force x"), HasSubstr("force y"), HasSubstr("moment z")));
  EXPECT_THAT(table, Not(HasSubstr("6.25")));
  const auto json = nlohmann::json::parse(thresholds_json(found));
  EXPECT_EQ(json["thresholds"][0]["force_N"]["value"], 6.25) << "what one for all would be";
  EXPECT_EQ(json["thresholds"][0]["force_by_component_N"][1]["value"], 7.5);
  EXPECT_EQ(json["thresholds"][0]["moment_by_component_Nm"].size(), 1U);
}

TEST(TheParameterFile, SaysOfWhichRobotsTheFusedDetectorKeepsTheRate) {
  ThresholdFindings found = with_a_residual(true);
  found.recordings = {{"a", "1"}, {"b", "2"}, {"c", "3"}};
  EXPECT_THAT(
      thresholds_yaml(found, "2026-11-22"),
      HasSubstr("\n#   fused detector: for robots that differ as those of the 3 recordings; how far"));
  EXPECT_THAT(warnings(found), IsEmpty());
  found.goal.one_robot = true;
  EXPECT_THAT(thresholds_yaml(found, "2026-11-22"),
              HasSubstr("\n#   fused detector: for the one robot that was recorded (--one-robot)\n"));
  EXPECT_EQ(nlohmann::json::parse(thresholds_json(found))["one_robot"], true);
}

TEST(OneRecording, OfOneOfManyRobotsIsWarnedOf) {
  ThresholdFindings found = with_a_residual(true);
  EXPECT_THAT(warnings(found), ElementsAre(HasSubstr("one recording does not tell how robots differ")));
  EXPECT_EQ(nlohmann::json::parse(thresholds_json(found))["warnings"].size(), 1U);
  found.goal.one_robot = true;
  EXPECT_THAT(warnings(found), IsEmpty());
  EXPECT_THAT(warnings(some), IsEmpty()) << "of plain thresholds";
}

TEST(Errors, ThatAreNotWhatTheirSizesSayAreWarnedOf) {
  ThresholdFindings found = with_a_residual(true);
  found.goal.one_robot = true;
  found.residuals[0].change.variation = 0.29;
  EXPECT_THAT(warnings(found), IsEmpty());
  found.residuals[0].change.variation = 9.5;
  EXPECT_THAT(warnings(found), ElementsAre(HasSubstr("the variance of its errors varies by 9.5 beside")));
  EXPECT_THAT(warnings(found), ElementsAre(HasSubstr("whether the robot failed or was touched")));
  found.residuals[0].change.between_robots = 9.4;
  EXPECT_THAT(warnings(found), ElementsAre(HasSubstr("the robots or their loads differ by so much")));
}

TEST(TheParameterFile, SaysWhichParameterFilesItRestsOnAndHowSurprisingTheMotionWas) {
  ThresholdFindings found = with_a_residual(true);
  found.with = {{"b/dynamics.yaml", "4567"}};
  found.residuals[0].level.threshold.largest = 6.5;
  found.residuals[0].change.threshold.largest = 7.25;
  found.residuals[0].onset->threshold.largest = 5.75;
  const std::string section = thresholds_yaml(found, "2026-11-22");
  EXPECT_THAT(section, HasSubstr("\n# Played again with\n#   b/dynamics.yaml, sha256 4567\n"));
  EXPECT_THAT(section, HasSubstr("\n#   level of the fused detector, filter, 90.0 s: 6.5\n"));
  EXPECT_THAT(section, HasSubstr("\n#   change of the fused detector, filter, 90.0 s: 7.25\n"));
  EXPECT_THAT(section, HasSubstr("\n#   onset of the fused detector, filter, 90.0 s: 5.75\n"));
}

TEST(TheParameterFile, OfAFusedDetectorHasTheUnitsOfTheDrives) {
  EXPECT_THAT(
      thresholds_yaml(with_a_residual(true), "2026-11-22"),
      HasSubstr(
          "  fused_detector:\n"
          "    tracking_per_s: 50\n"
          "    smoothing_per_s: 400\n"
          "    residuals:\n"
          "      - estimator: filter\n"
          "        level: {threshold: 8, noise_Nm: 0.25, speed_Nms_per_rad: 0.5, load: 0, torque: "
          "0.125, friction: 0.75, lag_ms: 500, rest_Nm: 0, acceleration_rad_per_s2: 0, turning: 0}\n"
          "        change: {threshold: 9.5, noise_Nm: 0.5, speed_Nms_per_rad: 0.25, load: 0.0625, "
          "torque: 0.5, friction: 1, lag_ms: 250, rest_Nm: 0, acceleration_rad_per_s2: 0, turning: 0}\n"
          "        smoothed: {threshold: 7.5, noise_Nm: 0.0625, speed_Nms_per_rad: 0.5, load: 0, "
          "torque: 0.25, friction: 0.5, lag_ms: 125, rest_Nm: 0.375, acceleration_rad_per_s2: 1.5, turning: "
          "0}\n"
          "        onset: {threshold: 6.5, innovation: 0.375, prediction: [0.5, 0.25, 0.125, -0.0625]}\n"));
  EXPECT_THAT(
      thresholds_yaml(with_a_residual(false), "2026-11-22"),
      AllOf(HasSubstr("noise_N: 0.25, speed_Ns_per_m: 0.5"), HasSubstr("acceleration_m_per_s2: 1.5")));
}

TEST(TheRobot, IsNotedWhereAllRecordingsAreOfOneAndItsTorqueConstantsWhereTheyAgree) {
  const Scenario one = read_scenario(FLINCH_SOURCE_DIR "/apps/scenarios/square.yaml");
  ThresholdFindings found;
  note_robot({one, one}, found);
  EXPECT_EQ(found.robot.sha256, calibrated_robot_hash(one.robot_text));
  ASSERT_EQ(found.assumed.size(), 3U);
  EXPECT_EQ(found.assumed[2].name, "drives.torque_constant_Nm_per_A[2]");
  EXPECT_EQ(found.assumed[2].value, one.control.drive_torque.torque_constant[2]);

  Scenario other = one;
  other.control.drive_torque.torque_constant[2] *= 1.01;
  found = {};
  note_robot({one, other}, found);
  EXPECT_NE(found.robot.sha256, "");
  EXPECT_TRUE(found.assumed.empty());

  other.robot_text += "# another\nkind: planar_3rrr\n";
  found = {};
  note_robot({one, other}, found);
  EXPECT_EQ(found.robot.sha256, "");
  EXPECT_THAT(thresholds_yaml(found, "2026-11-22"), Not(HasSubstr("robot:")));
}

TEST(TheSettings, OfEstimatorsAreNotedOnce) {
  const Scenario one = read_scenario(FLINCH_SOURCE_DIR "/apps/scenarios/square.yaml");
  ThresholdFindings found;
  found.recordings = {{"a.h5", ""}, {"b.h5", ""}};
  note_settings({one, one}, found);
  const std::string text = thresholds_yaml(found, "2026-11-22");
  const std::string gain =
      "  - {name: 'control.momentum_observer.gain', value: '[20, 20, 20]', unit: '1/s'}\n";
  ASSERT_THAT(text, HasSubstr(gain));
  EXPECT_THAT(text.substr(text.find(gain) + 1), Not(HasSubstr(gain)));
  EXPECT_THAT(text, AllOf(HasSubstr("velocity_filter.cutoff_frequency"), Not(HasSubstr("disturbance_filter")),
                          Not(HasSubstr("impedance"))));
}

TEST(TheSettings, MustBeThoseOfAllRecordings) {
  const Scenario one = read_scenario(FLINCH_SOURCE_DIR "/apps/scenarios/square.yaml");
  const Scenario other = read_scenario(
      FLINCH_SOURCE_DIR "/apps/scenarios/square.yaml",
      {"control.velocity_filter={cutoff_frequency_Hz: 60}", "control.impedance={damping_ratio: [2, 2, 2]}"});
  ThresholdFindings found;
  found.recordings = {{"a.h5", ""}, {"b.h5", ""}, {"c.h5", ""}};
  EXPECT_THAT(
      test::problems_of([&] {
        note_settings({one, one, other}, found);
      }),
      ElementsAre("c.h5: control.velocity_filter.cutoff_frequency was 60, and 30 in a.h5; thresholds hold "
                  "for one of them: calibrate from recordings that agree"));
}

TEST(TheRobot, MayHaveDrivesThatSlide) {
  ThresholdFindings found;
  note_robot({read_scenario(FLINCH_SOURCE_DIR "/apps/scenarios/hexapod_push.yaml")}, found);
  EXPECT_FALSE(found.drives_turn);
  ASSERT_EQ(found.assumed.size(), 6U);
  EXPECT_EQ(found.assumed[5].name, "drives.force_constant_N_per_A[5]");
}

TEST(TheObject, HasTheResidualsOfAFusedDetector) {
  const auto json = nlohmann::json::parse(thresholds_json(with_a_residual(true)));
  EXPECT_EQ(json["fused_detector"][0]["estimator"], "filter");
  EXPECT_EQ(json["fused_detector"][0]["change"]["value"], 9.5);
  EXPECT_EQ(json["fused_detector"][0]["level"]["torque"], 0.125);
  EXPECT_EQ(json["fused_detector"][0]["smoothed"]["value"], 7.5);
  EXPECT_EQ(json["fused_detector"][0]["smoothed"]["rest"], 0.375);
  EXPECT_EQ(json["fused_detector"][0]["smoothed"]["acceleration"], 1.5);
  EXPECT_EQ(json["fused_detector"][0]["smoothed"]["variation"], 0.0625);
  EXPECT_EQ(json["fused_detector"][0]["smoothed"]["between_robots"], 0.03125);
  EXPECT_EQ(json["fused_detector"][0]["onset"]["value"], 6.5);
  EXPECT_EQ(json["fused_detector"][0]["onset"]["innovation"], 0.375);
  EXPECT_EQ(json["fused_detector"][0]["onset"]["prediction"][3], -0.0625);
  EXPECT_TRUE(nlohmann::json::parse(thresholds_json(some))["fused_detector"].empty());
}

TEST(TheResults, HaveNoOnsetWhereSamplesHaveGapsBetweenAll) {
  ThresholdFindings found = with_a_residual(true);
  found.residuals[0].onset.reset();
  EXPECT_TRUE(nlohmann::json::parse(thresholds_json(found))["fused_detector"][0]["onset"].is_null());
  for (const std::string& text : {thresholds_table(found), thresholds_yaml(found, "2026-11-22")}) {
    EXPECT_THAT(text, HasSubstr("change"));
    EXPECT_THAT(text, Not(HasSubstr("onset:")));
    EXPECT_THAT(text, Not(HasSubstr("filter                 onset")));
  }
}

TEST(TheTable, ShowsTheErrorsThatAFusedDetectorReckonsWith) {
  EXPECT_THAT(thresholds_table(with_a_residual(true)), HasSubstr("noise and rest in Nm"));
  EXPECT_THAT(thresholds_table(with_a_residual(true)), HasSubstr("0.125"));
}

}  // namespace
}  // namespace flinch
