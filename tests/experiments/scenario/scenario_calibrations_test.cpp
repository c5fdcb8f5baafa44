#include "experiments/scenario/scenario_calibrations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "experiments/scenario/estimate_settings.h"
#include "experiments/scenario/scenario.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

/// Matches a doubt by its sentence.
auto Tells(const ::testing::Matcher<std::string>& sentence) {
  return ::testing::Field("sentence", &CalibrationWarning::sentence, sentence);
}

class Calibrations : public ::testing::Test {
 protected:
  ParameterFile made() const {
    ParameterFile file;
    file.kind = "torque-constant";
    file.date = "2026-11-22";
    file.robot = {"planar_3rrr.yaml",
                  calibrated_robot_hash(test::bytes_of(place / "robots/planar_3rrr.yaml"))};
    for (int i = 0; i < 3; ++i) {
      file.parameters.push_back({.name = "drives.torque_constant_Nm_per_A[" + std::to_string(i) + "]",
                                 .value = 7.0 + i,
                                 .belongs_to = "robot"});
    }
    file.parameters.push_back(
        {.name = "control.imu_mount.position_m[0]", .value = 0.07, .belongs_to = "scenario"});
    return file;
  }
  Scenario read(const ParameterFile& file, const std::string& control = "{}") const {
    place.write("scenarios/found.yaml", parameter_file_text(file));
    place.write("scenarios/own.yaml",
                "robot: ../robots/planar_3rrr.yaml\nduration_s: 1\ncalibrations: [{file: "
                "found.yaml}]\ncontrol: " +
                    control + "\n");
    return read_scenario(place / "scenarios/own.yaml");
  }

  test::Workplace place;
};

TEST_F(Calibrations, ChangeWhatIsBelievedAndNotWhatIsBuilt) {
  const Scenario scenario = read(made());
  EXPECT_EQ(scenario.robot.drives.torque_constant, Eigen::Vector3d(7.0, 8.0, 9.0));
  EXPECT_EQ(scenario.control.drive_torque.torque_constant, Eigen::Vector3d(7.0, 8.0, 9.0));
  EXPECT_EQ(scenario.robot_as_built.drives.torque_constant, Eigen::Vector3d(6.021, 6.6116, 6.7315));
  EXPECT_EQ(scenario.control.imu_mount.position_in_platform, Eigen::Vector3d(0.07, 0.001, -0.097));
  EXPECT_THAT(scenario.warnings, IsEmpty());
}

TEST_F(Calibrations, GiveWayToWhatTheScenarioSaysItself) {
  const Scenario scenario = read(made(), "{imu_mount: {position_m: [0, 0, 0]}}");
  EXPECT_EQ(scenario.control.imu_mount.position_in_platform, Eigen::Vector3d::Zero());
}

TEST_F(Calibrations, TellHowFarTheWrenchOfTheClassifiersIsOff) {
  const auto with = [&](const std::string& deviation) {
    place.write(
        "scenarios/thresholds.yaml",
        parameter_file_text(made()) + "control:\n  isolation: {drive_deviation_Nm: " + deviation + "}\n");
    place.write("scenarios/own.yaml",
                "robot: ../robots/planar_3rrr.yaml\nduration_s: 1\ncalibrations: [{file: "
                "thresholds.yaml}]\n");
    return read_scenario(place / "scenarios/own.yaml").control.isolation.uncertainty.drive_torque;
  };
  EXPECT_EQ(with("[0.1, 0.2, 0.3]"), Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_THAT(test::problems_of([&] { with("[0.1, 0.2]"); }), Contains(HasSubstr("drive_deviation")));
}

TEST_F(Calibrations, TellHowFarStampsOfTheImuErr) {
  ParameterFile file = made();
  file.parameters.push_back({.name = "control.imu_stamps.spread", .value = 1e-3, .belongs_to = "scenario"});
  EXPECT_EQ(read(file).control.imu_stamp_spread, 1ms);
  EXPECT_EQ(read(file, "{imu_stamps: {spread_us: 200}}").control.imu_stamp_spread, 200us);
  for (const double wrong : {-1e-6, 6e-3, std::nan("")}) {
    file.parameters.back().value = wrong;
    EXPECT_FALSE(test::problems_of([&] { read(file); }).empty()) << wrong;
  }
}

TEST_F(Calibrations, OfARobotFileThatHasChangedAreDoubted) {
  const ParameterFile file = made();
  place.replace("robots/planar_3rrr.yaml", "mass_kg: 0.642", "mass_kg: 0.7");
  EXPECT_THAT(read(file).warnings, ElementsAre(Tells(HasSubstr("the robot file has changed since"))));
}

TEST_F(Calibrations, MayBeNamedByTheRobotFileAsWell) {
  const ParameterFile file = made();
  place.write("robots/found.yaml", parameter_file_text(file));
  const std::string robot = test::bytes_of(place / "robots/planar_3rrr.yaml");
  place.write("robots/planar_3rrr.yaml", robot + "\ncalibrations:\n  - {file: found.yaml}\n");
  place.write("scenarios/plain.yaml", "robot: ../robots/planar_3rrr.yaml\nduration_s: 1\n");
  const Scenario scenario = read_scenario(place / "scenarios/plain.yaml");
  EXPECT_EQ(scenario.robot.drives.torque_constant, Eigen::Vector3d(7.0, 8.0, 9.0));
  EXPECT_EQ(scenario.robot_as_built.drives.torque_constant, Eigen::Vector3d(6.021, 6.6116, 6.7315));
  EXPECT_EQ(scenario.calibrations.size(), 1U);
  EXPECT_THAT(scenario.warnings, IsEmpty()) << "to take them over is no change of the robot";
}

TEST_F(Calibrations, OfTheScenarioReplaceThoseOfTheRobotFileAndThatIsSaid) {
  ParameterFile file = made();
  place.write("robots/before.yaml", parameter_file_text(file));
  const std::string robot = test::bytes_of(place / "robots/planar_3rrr.yaml");
  place.write("robots/planar_3rrr.yaml", robot + "\ncalibrations: [{file: before.yaml}]\n");
  file.parameters[0].value = 7.5;
  const Scenario scenario = read(file);
  EXPECT_EQ(scenario.robot.drives.torque_constant, Eigen::Vector3d(7.5, 8.0, 9.0));
  EXPECT_THAT(scenario.warnings, Contains(Tells(HasSubstr("found.yaml: replaces what"))));
}

TEST_F(Calibrations, ThatTheRobotFileNamesAndThatAreNotThereAreToldWithTheirLine) {
  const std::string robot = test::bytes_of(place / "robots/planar_3rrr.yaml");
  place.write("robots/planar_3rrr.yaml", "calibrations: [{file: gone.yaml}]\n" + robot);
  EXPECT_THAT(test::problems_of([&] { read(made()); }),
              Contains(HasSubstr("planar_3rrr.yaml:1: calibrations[0].file: is 'gone.yaml'")));
}

TEST_F(Calibrations, ThatRestOnOtherSettingsOfAnEstimatorThatRunsAreDoubted) {
  ParameterFile file = made();
  file.settings = estimate_settings(read(file));
  ASSERT_GE(file.settings.size(), 4U);
  EXPECT_THAT(read(file).warnings, IsEmpty());
  EXPECT_THAT(
      read(file, "{velocity_filter: {cutoff_frequency_Hz: 60}}").warnings,
      ElementsAre(Tells(HasSubstr("found.yaml: rests on control.velocity_filter.cutoff_frequency = 30 "
                                  "Hz, and 60 Hz is used; calibrate"))));
  EXPECT_THAT(read(file, "{drive_torque: {aligned_with_velocity: false}}").warnings,
              ElementsAre(Tells(HasSubstr("aligned_with_velocity = true, and false is used"))));
  EXPECT_THAT(
      read(file, "{momentum_observer: {gain_per_s: [20, 20, 50]}}").warnings,
      ElementsAre(Tells(HasSubstr("momentum_observer.gain = [20, 20, 20] 1/s, and [20, 20, 50] 1/s"))));
  EXPECT_THAT(
      read(file, "{disturbance_filter: {pole_per_s: 100}, impedance: {damping_ratio: [2, 2, 2]}}").warnings,
      IsEmpty())
      << "neither has an estimate that rests on it";
  EXPECT_THAT(read(file, "{estimators: [disturbance_filter]}").warnings, IsEmpty()) << "it runs no more";
}

TEST_F(Calibrations, RestOnWhatAnEstimatorBringsThatRunsNowhereElse) {
  const auto keys = [&](const std::string& estimator) {
    std::set<std::string> sections;
    for (const ReadValue& setting :
         estimate_settings(read(made(), "{estimators: [" + estimator + "], accelerations: [imu_ekf]}"))) {
      const std::string key = setting.key.substr(std::string("control.").size());
      sections.insert(key.substr(0, key.find('.')));
    }
    return sections;
  };
  const std::set<std::string> always{"drive_torque", "follow",    "velocity_filter", "imu_ekf",
                                     "isolation",    "imu_mount", "imu_stamps",      "plausibility"};
  const auto with = [&](std::set<std::string> more) {
    more.insert(always.begin(), always.end());
    return more;
  };
  EXPECT_EQ(keys("momentum_observer"), with({"momentum_observer"}));
  EXPECT_EQ(keys("direct_method"), with({"momentum_observer"}));
  EXPECT_EQ(keys("direct_extended_imu_ekf"),
            with({"extended_imu_ekf", "disturbance_filter", "momentum_observer"}));
  EXPECT_EQ(keys("imu_residual"), with({"imu_residual", "disturbance_filter", "momentum_observer"}));
}

TEST_F(Calibrations, ThatRestOnOtherTorqueConstantsAreDoubted) {
  ParameterFile file = made();
  file.kind = "dynamics";
  file.assumed = {{.name = "drives.torque_constant_Nm_per_A[1]", .value = 6.6}};
  EXPECT_THAT(read(file).warnings,
              ElementsAre(Tells(HasSubstr("rests on drives.torque_constant_Nm_per_A[1] = 6.6"))));
}

TEST_F(Calibrations, OfARobotWithMoreLegsAreRefusedByTheirName) {
  ParameterFile file = made();
  file.parameters.push_back(
      {.name = "legs[2].active_friction.coulomb_Nm", .value = 0.5, .belongs_to = "robot"});
  read(file);
  place.write("scenarios/own.yaml",
              "robot: ../robots/five_bar.yaml\nduration_s: 1\ncalibrations: [{file: found.yaml}]\n");
  EXPECT_THAT(test::problems_of([&] { read_scenario(place / "scenarios/own.yaml"); }),
              Contains(AllOf(StartsWith(place.at("scenarios/found.yaml") + ": does not fit "),
                             HasSubstr("five_bar.yaml: "))));
}

TEST_F(Calibrations, ThatDoNotFitTheRobotAreRefused) {
  ParameterFile file = made();
  file.parameters.push_back({.name = "legs[5].rotor_inertia_kg_m2", .value = 1.0, .belongs_to = "robot"});
  EXPECT_THAT(test::problems_of([&] { read(file); }), Contains(HasSubstr("the list has 3 entries")));
}

}  // namespace
}  // namespace flinch
