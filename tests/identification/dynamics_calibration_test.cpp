#include "identification/dynamics_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <limits>

#include "identification/dynamics_fit.h"
#include "systems/robot/planar_rrr.h"
#include "systems/signals/drive_reading.h"
#include "tests/identification/free_motion_errors.h"
#include "tests/identification/recorded.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using test::edit;
using test::Simulated;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using test::excitation_realism;
using test::only_parameters;

DynamicsBelief belief(const Simulated& run) {
  return {.robot = run.scenario.robot.robot.get(),
          .drives = run.scenario.robot.drives,
          .constant = run.scenario.control.drive_torque.torque_constant};
}

CalibrationResult calibrated(const Simulated& run) {
  return calibrate_dynamics(belief(run), {{{"run.h5", ""}, &run.recording}}, {});
}

TEST(Dynamics, PredictTheTorqueOfAnUnseenMotionToOnePercentBeyondNoise) {
  for (const char* const realism : {only_parameters, excitation_realism}) {
    const Simulated run = test::simulated("calibration_excitation.yaml", {{excitation_realism, realism}});
    const Simulated other = test::simulated(
        "random_motion.yaml", {{"plant: {realism: bench}", realism}, {"duration_s: 36", "duration_s: 15"}});
    const CalibrationResult got = calibrate_dynamics(belief(run), {{{"run.h5", ""}, &run.recording}},
                                                     {{{"other.h5", ""}, &other.recording}});
    EXPECT_TRUE(got.warnings.empty()) << got.warnings.front();
    ASSERT_FALSE(got.notes.empty());
    double percent = 100.0;
    for (const std::string& note : got.notes) {
      const std::size_t at = note.find("(RMS), ");
      if (at != std::string::npos) percent = std::stod(note.substr(at + 7));
    }
    std::printf("  %s: %.2f %%\n", realism, percent);
    EXPECT_LT(percent, 1.0) << ::testing::PrintToString(got.notes);
    EXPECT_LT(got.residual_after, 0.3 * got.residual_before);
  }
}

TEST(Dynamics, FindWhatIsTrueWithinTheirDeviations) {
  const Simulated run =
      test::simulated("calibration_excitation.yaml", {{excitation_realism, only_parameters}});
  const CalibrationResult got = calibrated(run);
  const auto& truth = dynamic_cast<const PlanarRrr&>(*run.scenario.station.rig.robot).parameters();
  int found = 0;
  for (const CalibratedParameter& parameter : got.parameters) {
    if (!parameter.identifiable) continue;
    for (int leg = 0; leg < 3; ++leg) {
      const PlanarRrrLeg& of = truth.legs[static_cast<std::size_t>(leg)];
      const std::string at = "legs[" + std::to_string(leg) + "].";
      const std::map<std::string, double> known = {
          {at + "active_friction.coulomb_Nm", of.active_friction.coulomb},
          {at + "passive_friction.viscous_Nms_per_rad", of.passive_friction.viscous}};
      const auto true_value = known.find(parameter.name);
      if (true_value == known.end()) continue;
      ++found;
      EXPECT_NEAR(parameter.value, true_value->second, 3.0 * *parameter.deviation) << parameter.name;
    }
  }
  EXPECT_GE(found, 5);
}

TEST(Dynamics, HalveWhatTheObserverTakesForAContact) {
  const test::FreeMotionErrors errors = test::free_motion_errors(1, test::only_parameters);
  EXPECT_LT(errors.after, 0.5 * errors.before);
}

// Friction, arms, rods and a payload of a robot of legs, from base parameters.
TEST(Dynamics, OfADeltaPredictItsTorqueOnAnUnseenMotion) {
  const Simulated run =
      test::simulated("delta_calibration_excitation.yaml", {{"duration_s: 19.0", "duration_s: 10"}});
  const Simulated other =
      test::simulated("delta_calibration_motion.yaml",
                      {{"duration_s: 45", "duration_s: 5"}, {"duration_s: 43", "duration_s: 4"}});
  const CalibrationResult got = calibrate_dynamics(belief(run), {{{"run.h5", ""}, &run.recording}},
                                                   {{{"other.h5", ""}, &other.recording}});
  EXPECT_TRUE(got.contradictions.empty()) << ::testing::PrintToString(got.contradictions);
  EXPECT_LT(got.residual_after, 0.1 * got.residual_before);
  ASSERT_EQ(got.validation.size(), 3U);
  for (const auto& drive : got.validation) {
    EXPECT_LT(std::abs(drive.median), 0.1) << drive.name;  // before it was 0.4 Nm, for the payload
    EXPECT_LT(drive.high - drive.low, 0.3) << drive.name;
  }
  const auto mass = std::find_if(got.parameters.begin(), got.parameters.end(),
                                 [](const auto& parameter) { return parameter.name == "platform.mass_kg"; });
  ASSERT_NE(mass, got.parameters.end());
  EXPECT_TRUE(mass->identifiable);
  EXPECT_NEAR(mass->value, 0.75, 0.12) << "0.45 kg and 10 %, and 0.3 kg of payload, and what rods differ by";
}

TEST(DynamicsFit, HasTheJacobianOfItsRows) {
  DynamicsRows rows;
  RandomGenerator random(1);
  rows.regressor.resize(60, 4);
  rows.surplus.resize(60);
  rows.torque.setZero(60);
  const Eigen::Vector4d truth(0.5, -0.2, 0.1, 0.3);
  for (int row = 0; row < 60; ++row) {
    for (int j = 0; j < 4; ++j) rows.regressor(row, j) = random.normal();
    rows.drive.push_back(row % 2);
    rows.cluster.push_back(row / 6);
    rows.recording.push_back(0);
    rows.surplus[row] =
        rows.regressor.row(row).dot(truth) + (row % 2 == 0 ? 0.05 : -0.05) + 1e-3 * random.normal();
  }
  std::vector<DynamicParameter> parameters(
      4, {.name = "p", .unit = "", .believed = 0.0, .deviation = 2.0, .least = -9.0});
  const DynamicsFit fit = fit_dynamics(rows, parameters, 2, 1.0, std::vector<bool>(4, false));
  EXPECT_LT((fit.values - truth).norm(), 2e-3);
  EXPECT_NEAR(fit.offset[0], 0.05, 1e-3);
  for (int row = 0; row < 60; ++row) {
    const double sigma = fit.deviation[row % 2];
    EXPECT_LT((fit.linear.jacobian.row(row).head(4) - rows.regressor.row(row) / sigma).norm(), 1e-6 / sigma);
    EXPECT_NEAR(fit.linear.jacobian(row, 4 + row % 2), 1.0 / sigma, 1e-6 / sigma);
  }
  parameters[1].least = 0.0;
  EXPECT_GE(fit_dynamics(rows, parameters, 2, 1.0, std::vector<bool>(4, false)).values[1], -1e-12)
      << "nothing is below what is possible";
}

TEST(BadMotions, ThatAreTooShortAreRefused) {
  Simulated run = test::simulated("calibration_excitation.yaml");
  edit<DriveReading>(run.recording, "drives",
                     [](std::size_t k, DriveReading& reading) { reading.valid = k < 3000; });
  EXPECT_THAT(test::problems_of([&] { calibrated(run); }),
              Contains(HasSubstr("too short: 2.6 s of motion with a usable current of drive 1")));
}

TEST(BadMotions, AtStandstillAreRefused) {
  EXPECT_THAT(
      test::problems_of([&] {
        calibrated(test::simulated("calibration_standstill.yaml", {{"duration_s: 5", "duration_s: 8"}}));
      }),
      Contains(HasSubstr("drive 1 is not excited")));
}

TEST(BadMotions, WithoutCurrentsAreRefused) {
  Simulated run = test::simulated("calibration_excitation.yaml");
  std::erase_if(run.recording.signals, [](const Signal& signal) { return signal.path == "drives"; });
  EXPECT_THAT(test::problems_of([&] { calibrated(run); }),
              ElementsAre(HasSubstr("run.h5: there is no signal 'drives', the motor currents; record them")));
}

TEST(BadMotions, WithoutTheCurrentOfADriveAreRefused) {
  Simulated run = test::simulated("calibration_excitation.yaml");
  edit<DriveReading>(run.recording, "drives", [](std::size_t, DriveReading& reading) {
    reading.current[1] = std::numeric_limits<double>::quiet_NaN();
  });
  EXPECT_THAT(
      test::problems_of([&] { calibrated(run); }),
      ElementsAre(HasSubstr("0.0 s of motion with a usable current of drive 2"),
                  HasSubstr("run.h5: the current of drive 2 is missing in 100 % of the samples, which "
                            "are left out; check its amplifier and the link to it")));
}

/// None of some thirty parameters is off by more than three deviations from what it is without the defect.
/// Waves of cogging are compared by their sum: which of them is the second of a drive depends on how many are
/// found.
void expect_within_deviations(const Simulated& run, const CalibrationResult& clean,
                              const CalibrationResult& spoilt) {
  for (std::size_t i = 0; i < clean.parameters.size(); ++i) {
    const CalibratedParameter &of_clean = clean.parameters[i], &of_spoilt = spoilt.parameters[i];
    if (of_clean.name.starts_with("drives.cogging")) continue;
    if (!of_clean.identifiable || !of_spoilt.identifiable) continue;
    EXPECT_LT(std::abs(of_spoilt.value - of_clean.value), 3.0 * *of_spoilt.deviation) << of_clean.name;
  }
  const ParallelRobot& robot = *run.scenario.robot.robot;
  Kinematics home;
  robot.kinematics(robot.home_pose(), PlatformVector::Zero(robot.dof()), home);
  for (int drive = 0; drive < 3; ++drive) {
    const Cogging one = test::found_cogging(clean, drive), other = test::found_cogging(spoilt, drive);
    for (double from_home = -0.3; from_home < 0.3; from_home += 0.01) {
      const JointVector q = JointVector::Constant(1, home.joints.active[drive] + from_home);
      EXPECT_NEAR(other.at(q)[0], one.at(q)[0], 0.1) << drive << " " << from_home;
    }
  }
}

TEST(BadMotions, WithGapsInTheCurrentOfADriveAreNamedAndUsedWithoutThem) {
  Simulated run = test::simulated("calibration_excitation.yaml");
  const CalibrationResult clean = calibrated(run);
  edit<DriveReading>(run.recording, "drives", [](std::size_t k, DriveReading& reading) {
    if (k % 1000 < 50) reading.current[1] = std::numeric_limits<double>::quiet_NaN();
  });
  const CalibrationResult spoilt = calibrated(run);
  EXPECT_THAT(spoilt.warnings,
              Contains(HasSubstr("the current of drive 2 is missing in 5 % of the samples")));
  expect_within_deviations(run, clean, spoilt);
}

TEST(BadMotions, WithASaturatedCurrentAreNamedAndUsedWithoutIt) {
  Simulated run = test::simulated("calibration_excitation.yaml");
  const CalibrationResult clean = calibrated(run);
  test::saturate_current(run.recording, 0, 0.4);
  const CalibrationResult spoilt = calibrated(run);
  EXPECT_THAT(spoilt.warnings, Contains(HasSubstr("the current of drive 1 is saturated at")));
  expect_within_deviations(run, clean, spoilt);
}

TEST(BadMotions, WithContactAreRefused) {
  EXPECT_THAT(test::problems_of([&] { calibrated(test::simulated("platform_collision.yaml")); }),
              ElementsAre(HasSubstr("something touched or pushed the robot at 0.5")));
}

TEST(BadMotions, WithSwappedCurrentsAreRefused) {
  Simulated run = test::simulated("calibration_excitation.yaml");
  edit<DriveReading>(run.recording, "drives", [](std::size_t, DriveReading& reading) {
    std::swap(reading.current[0], reading.current[2]);
  });
  EXPECT_THAT(test::problems_of([&] { calibrated(run); }),
              Contains(HasSubstr("currents or legs are swapped")));
}

TEST(BadMotions, WithCurrentsOfAnotherTimeThanTheEncodersAreRefused) {
  Simulated run = test::simulated("calibration_excitation.yaml");
  std::deque<JointVector> older(4, JointVector::Zero(3));
  edit<DriveReading>(run.recording, "drives", [&](std::size_t, DriveReading& reading) {
    older.push_back(reading.current);
    reading.current = older.front();
    older.pop_front();
  });
  EXPECT_THAT(test::problems_of([&] { calibrated(run); }),
              Contains(HasSubstr("ahead of its current; more than 1 ms cannot be: check the times")));
}

TEST(AFifthOfOutliers, MovesNoDynamicParameterByMoreThanThreeDeviations) {
  Simulated run = test::simulated("calibration_excitation.yaml");
  const CalibrationResult clean = calibrated(run);
  RandomGenerator random(3);
  edit<DriveReading>(run.recording, "drives", [&](std::size_t, DriveReading& reading) {
    if (random.uniform(0.0, 1.0) < 0.2) reading.current[1] += random.uniform(-20.0, 20.0);
  });
  const CalibrationResult spoilt = calibrated(run);
  EXPECT_THAT(spoilt.warnings, Contains(HasSubstr("are spikes")));
  expect_within_deviations(run, clean, spoilt);
}

}  // namespace
}  // namespace flinch
