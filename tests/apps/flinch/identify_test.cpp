// flinch calibrate torque-constant and its kin, as typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "systems/framework/table_file.h"
#include "tests/apps/flinch/documented_keys.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::flinch;
using test::Outcome;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Identify : public ::testing::Test {
 protected:
  std::string recorded(const std::string& scenario) const {
    EXPECT_EQ(
        flinch({"run", place.at("scenarios/" + scenario + ".yaml"), "--out", place.at(scenario), "--quiet"})
            .status,
        0);
    return place.at(scenario + "/run.h5");
  }

  test::Workplace place;
};

TEST_F(Identify, TorqueConstantsAreToldAsAnObject) {
  const std::string recording = recorded("calibration_pulls");
  const Outcome outcome = flinch({"calibrate", "torque-constant", recording, "--json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["kind"], "torque-constant");
  EXPECT_THAT(test::undocumented_keys(json, "Calibration"), IsEmpty());
  EXPECT_EQ(json["recordings"], nlohmann::json::array({recording}));
  EXPECT_EQ(json["sha256"][0].get<std::string>().size(), 64U);
  const auto& first = json["parameters"][0];
  EXPECT_EQ(first["name"], "drives.torque_constant_Nm_per_A[0]");
  EXPECT_NEAR(first["value"], 6.021, 0.03);
  EXPECT_GT(first["standard_deviation"], 0.0);
  EXPECT_EQ(first["unit"], "Nm/A");
  EXPECT_EQ(first["identifiable"], true);
  EXPECT_LT(json["residual_after"], json["residual_before"]);
  EXPECT_TRUE(json["warnings"].empty()) << json["warnings"];
}

TEST_F(Identify, ReadingsThatCannotBeRightAreRefusedUnlessTheyAreAccepted) {
  flinch({"run", place.at("scenarios/calibration_rectangle.yaml"), "--fault", "accelerometer:scaled@0:-1",
          "--out", place.at("wrong"), "--quiet"});
  const std::string recording = place.at("wrong/run.h5"), file = place.at("imu.yaml");
  const Outcome refused = flinch({"calibrate", "imu-pose", recording, "--out", file});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("the accelerometer has the other sign"));
  EXPECT_THAT(refused.err, HasSubstr("--accept"));
  EXPECT_FALSE(std::filesystem::exists(file));
  const Outcome accepted = flinch({"calibrate", "imu-pose", recording, "--out", file, "--accept"});
  EXPECT_EQ(accepted.status, 0) << accepted.err;
  EXPECT_THAT(accepted.err, HasSubstr("warning: the accelerometer has the other sign"));
  EXPECT_TRUE(std::filesystem::exists(file));
}

TEST_F(Identify, AParameterFileIsTakenOverByAScenario) {
  const std::string recording = recorded("calibration_rectangle");
  const std::string file = place.at("scenarios/imu.yaml");
  EXPECT_EQ(flinch({"calibrate", "imu-pose", recording, "--out", file, "--quiet"}).status, 0);
  EXPECT_THAT(flinch({"check", file}).out, HasSubstr("a good calibration file"));
  EXPECT_THAT(test::bytes_of(place.at("scenarios/imu.html")), HasSubstr("accelerometer x"));
  place.replace("scenarios/square.yaml", "duration_s: 3.5",
                "duration_s: 0.5\ncalibrations: [{file: imu.yaml}]");
  const Outcome run =
      flinch({"run", place.at("scenarios/square.yaml"), "--out", place.at("square"), "--json"});
  EXPECT_TRUE(nlohmann::json::parse(run.out)["remarks"].empty()) << run.out;
  place.replace("robots/planar_3rrr.yaml", "mass_kg: 0.642", "mass_kg: 0.65");
  const Outcome changed =
      flinch({"run", place.at("scenarios/square.yaml"), "--out", place.at("square"), "--json"});
  EXPECT_THAT(nlohmann::json::parse(changed.out)["remarks"].dump(),
              HasSubstr("the robot file has changed since"));
}

TEST_F(Identify, AllThatAFolderAllowsIsCalibratedInOrder) {
  for (const char* const scenario : {"calibration_pulls", "calibration_excitation", "calibration_rectangle"})
    recorded(scenario);
  write_table({}, 0, {}, {{"format", "flinch campaign"}}, place / "results.h5");  // which is left out
  const Outcome outcome = flinch({"calibrate", "all", place.at(""), "--out", place.at("found"), "--json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["kind"], "all");
  EXPECT_THAT(test::undocumented_keys(json, "Calibration"), IsEmpty());
  ASSERT_EQ(json["calibrations"].size(), 3U);
  EXPECT_EQ(json["calibrations"][0]["kind"], "torque-constant");
  EXPECT_EQ(json["calibrations"][1]["kind"], "dynamics");
  EXPECT_EQ(json["calibrations"][2]["kind"], "imu-pose");
  EXPECT_THAT(json["warnings"].dump(), HasSubstr("thresholds: not calibrated, for no recording below"));
  for (const char* const file : {"found/torque_constant.yaml", "found/dynamics.yaml", "found/imu_pose.html"})
    EXPECT_FALSE(test::bytes_of(place / file).empty()) << file;
}

TEST_F(Identify, ThresholdsOfAFolderMayBeOfEachComponent) {
  recorded("calibration_motion");
  const auto json =
      nlohmann::json::parse(flinch({"calibrate", "all", place.at(""), "--by-component", "--json"}).out);
  EXPECT_THAT(test::undocumented_keys(json, "Calibration"), IsEmpty());
  const auto& found = json["thresholds_after"][0];
  EXPECT_TRUE(found["force_N"].is_number()) << "what one for all would be";
  ASSERT_EQ(found["force_by_component_N"].size(), 2U);
  EXPECT_NE(found["force_by_component_N"][0], found["force_by_component_N"][1]);
  EXPECT_EQ(found["moment_by_component_Nm"].size(), 1U);
  EXPECT_THAT(test::bytes_of(place.at("calibration/thresholds.yaml")), HasSubstr("reaction_force_N: ["));
}

TEST_F(Identify, ARecordingIsUsedOnce) {
  place.replace("scenarios/square.yaml", "duration_s: 3.5", "duration_s: 1");
  const std::string square = recorded("square");
  const std::string copy = place.at("copy.h5");
  std::filesystem::copy_file(square, copy);
  const auto refused = HasSubstr("copy.h5: holds the same as " + square + "; leave one of them out");
  EXPECT_THAT(flinch({"calibrate", "dynamics", square, copy}).err, refused);
  EXPECT_THAT(flinch({"calibrate", "dynamics", square, "--validate", copy}).err, refused);
  EXPECT_THAT(flinch({"calibrate", "imu-pose", square, copy}).err, refused);
  EXPECT_THAT(flinch({"calibrate", "thresholds", square, copy}).err, refused);
  place.write("twice.yaml", "recordings: [{file: square/run.h5}, {file: copy.h5}]");
  EXPECT_THAT(flinch({"dataset", place.at("twice.yaml"), "--out", place.at("twice.h5")}).err,
              HasSubstr("recordings[1].file: is the recording of an entry before it; leave one of them out"));
}

TEST_F(Identify, ARecordingIsNotReplacedByTheDataThatAreMadeOfIt) {
  place.replace("scenarios/square.yaml", "duration_s: 3.5", "duration_s: 1");
  const std::string square = recorded("square");
  place.write("data.yaml", "recordings: [{file: square/run.h5, touched: platform}]");
  EXPECT_THAT(flinch({"dataset", place.at("data.yaml"), "--out", square}).err,
              HasSubstr("square/run.h5: is read by this call, which would replace it"));
}

TEST_F(Identify, AFolderWithoutACalibrationStaysAsItWas) {
  place.write("scenarios/own.yaml", "robot: ../robots/planar_3rrr.yaml\nduration_s: 0.3\n");
  recorded("own");
  const Outcome outcome = flinch({"calibrate", "all", place.at("own")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("own/run.h5: is for no calibration and is left out"));
  EXPECT_THAT(outcome.err, HasSubstr("own: no recording below it is for a calibration"));
  EXPECT_FALSE(std::filesystem::exists(place / "own/calibration"));
}

TEST_F(Identify, AMotionThatExcitesIsAScenarioThatRuns) {
  const std::string file = place.at("scenarios/own.yaml");
  const Outcome outcome = flinch({"excite", place.at("robots/planar_3rrr.yaml"), "--out", file, "--duration",
                                  "5", "--trials", "30", "--json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_LE(json["condition"], json["first_condition"]);
  EXPECT_THAT(test::undocumented_keys(json, "Calibration"), IsEmpty());
  EXPECT_EQ(flinch({"check", file}).status, 0) << flinch({"check", file}).err;
}

TEST_F(Identify, AMotionNamesARobotFileWhateverItIsCalled) {
  const std::string robot = place.at("robots/robot #2: mine.yaml");
  std::filesystem::copy_file(place / "robots/five_bar.yaml", robot);
  const std::string file = place.at("scenarios/own.yaml");
  const Outcome outcome =
      flinch({"excite", robot, "--out", file, "--duration", "2", "--trials", "1", "--quiet"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(flinch({"check", file}).err, "");
}

TEST_F(Identify, TellsEveryRecordingThatWillNotDo) {
  place.replace("scenarios/square.yaml", "duration_s: 3.5", "duration_s: 1");
  const std::string square = recorded("square");
  const Outcome outcome = flinch({"calibrate", "torque-constant", square, place.at("none.h5")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("none.h5: there is no such file"));
  EXPECT_THAT(flinch({"calibrate", "torque-constant", square}).err,
              HasSubstr("square/run.h5: its scenario has no 'pulls'"));
  place.write("other.yaml",
              "flinch_calibration: 1\nkind: imu-pose\ndate: '2026-01-01'\nrobot: {file: a.yaml, sha256: '" +
                  std::string(64, '0') +
                  "'}\n"
                  "parameters: [{name: delay, value: 0.003, unit: s, identifiable: true}]\n");
  EXPECT_THAT(flinch({"calibrate", "dynamics", square, "--with", place.at("other.yaml")}).err,
              HasSubstr("other.yaml: is of kind 'imu-pose'; only torque constants are used"));
}

}  // namespace
}  // namespace flinch
