#include "identification/motor_parameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <string>

#include "identification/dynamics_calibration.h"
#include "plant/perturbed_robot.h"
#include "systems/framework/random.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/identification/free_motion_errors.h"

namespace flinch {
namespace {

const PlanarRrr& rig() {
  static const PlanarRrr robot(rig_robot(RigGeometry::nominal, RigFriction::simulation));
  return robot;
}

DriveParameters drives() { return default_drives(DriveKind::revolute, 3); }

/// Of drives that go to and fro: two of them cog.
const std::vector<DriveWave> truth = {{.drive = 0, .rate = 24.0, .sine = 0.1, .cosine = 0.17},
                                      {.drive = 0, .rate = 48.0, .sine = 0.03, .cosine = -0.06},
                                      {.drive = 0, .rate = 62.0, .sine = 0.04, .cosine = 0.02},
                                      {.drive = 1, .rate = 22.0, .sine = -0.3, .cosine = 0.2}};

constexpr double noise = 0.02;  // of a torque [Nm]

/// Rows of their motion, in which no dynamic parameter of the robot does anything.
DynamicsRows cogging_rows(Eigen::Index parameters) {
  constexpr int samples = 20000, step = 10;
  constexpr double period = 1e-3;
  DynamicsRows rows;
  rows.paths = {{Eigen::MatrixXd(samples, 3), period}};
  for (int k = 0; k < samples; ++k) {
    for (int i = 0; i < 3; ++i) {
      rows.paths[0].position(k, i) = 0.8 * std::sin((4.0 + 1.5 * i) * period * k);
    }
  }
  for (int k = 500; k < samples - 500; k += step) {
    for (int i = 0; i < 3; ++i) {
      rows.drive.push_back(i);
      rows.path.push_back(0);
      rows.sample.push_back(k);
      rows.time.push_back(period * k);
      rows.cluster.push_back(k / 500);
      rows.recording.push_back(0);
    }
  }
  const auto n = static_cast<Eigen::Index>(rows.drive.size());
  rows.torque.setZero(n);
  rows.surplus.setZero(n);
  rows.slope.setZero(n);
  rows.regressor.setZero(n, parameters);
  for (const DriveWave& wave : truth) {
    rows.surplus -= along_the_way(rows, wave.drive, [&](double q) -> Eigen::RowVector3d {
                      const double w =
                          wave.sine * std::sin(wave.rate * q) + wave.cosine * std::cos(wave.rate * q);
                      return {w, 0.0, 0.0};
                    }).col(0);
  }
  RandomGenerator random(1);
  for (double& value : rows.surplus) value += noise * random.normal();
  return rows;
}

TEST(MotorParameters, AreFoundOfTheDrivesThatCog) {
  const DynamicsRows rows = cogging_rows(0);
  const std::vector<DriveWave> waves = find_cogging(rows, rows.surplus, 3);
  ASSERT_EQ(waves.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_EQ(waves[i].drive, truth[i].drive);
    EXPECT_NEAR(waves[i].rate, truth[i].rate, 0.05) << i;
    EXPECT_NEAR(waves[i].sine, truth[i].sine, 0.01) << i;
    EXPECT_NEAR(waves[i].cosine, truth[i].cosine, 0.01) << i;
  }
}

// The last column is how what the first two make of the surplus changes with the rate.
TEST(MotorParameters, HaveTheColumnsOfTheirRows) {
  const auto robot = DynamicParameters::of(rig());
  const auto p = static_cast<Eigen::Index>(robot->list().size());
  const DriveWave wave{
      .drive = 1, .rate = 24.0, .deviation = 1.0, .least = 10.0, .sine = 0.3, .cosine = -0.2};
  const auto made_by = [&](double rate) {
    DriveWave other = wave;
    other.rate = rate;
    const MotorParameters parameters(*robot, {other}, DriveKind::revolute, drives());
    const DynamicsRows rows = parameters.rows(cogging_rows(p));
    const Eigen::Index first = parameters.first_of_waves();
    return Eigen::VectorXd(rows.regressor.col(first) * wave.sine +
                           rows.regressor.col(first + 1) * wave.cosine);
  };
  const DynamicsRows rows =
      MotorParameters(*robot, {wave}, DriveKind::revolute, drives()).rows(cogging_rows(p));
  const Eigen::VectorXd difference = (made_by(24.0 + 1e-4) - made_by(24.0 - 1e-4)) / 2e-4;
  EXPECT_LT((difference - rows.regressor.rightCols(1)).lpNorm<Eigen::Infinity>(), 1e-7);
  for (Eigen::Index row = 0; row < rows.surplus.size(); ++row) {
    if (rows.drive[static_cast<std::size_t>(row)] != 1) {
      ASSERT_TRUE(rows.regressor.row(row).tail(3).isZero(0.0));
    }
  }
}

TEST(MotorParameters, StandInTheFileForAllDrivesOrForNone) {
  const auto robot = DynamicParameters::of(rig());
  const MotorParameters none(*robot, {}, DriveKind::revolute, drives());
  const std::size_t but_for_cogging = robot->in_file(robot->believed()).size() + 3;  // with the delays
  EXPECT_EQ(none.in_file(none.believed()).size(), but_for_cogging);

  const MotorParameters some(*robot, {{.drive = 2, .rate = 24.0, .deviation = 1.0, .least = 10.0}},
                             DriveKind::revolute, drives());
  Eigen::VectorXd values = some.believed();
  values.tail(3) << 0.3, -0.2, 25.0;
  const std::vector<FileValue> file = some.in_file(values);
  ASSERT_EQ(file.size(), but_for_cogging + 9);
  const double expected[] = {1.0, 1.0, 2.0 * std::numbers::pi / 25.0, 0.0, 0.0, 0.3, 0.0, 0.0, -0.2};
  const char* const names[] = {"wavelength_rad[0]", "wavelength_rad[1]", "wavelength_rad[2]",
                               "sine_Nm[0]",        "sine_Nm[1]",        "sine_Nm[2]",
                               "cosine_Nm[0]",      "cosine_Nm[1]",      "cosine_Nm[2]"};
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(file[but_for_cogging + i].name, std::string("drives.cogging_") + names[i]);
    EXPECT_NEAR(file[but_for_cogging + i].value, expected[i], 1e-15);
  }
}

// Who believed in cogging and finds none says so, or the old one would stay.
TEST(MotorParameters, TakeBackWhatWasBelieved) {
  const auto robot = DynamicParameters::of(rig());
  DriveParameters believing = drives();
  believing.cogging = {
      {{JointVector::Constant(3, 0.26), JointVector::Ones(3), JointVector{{0.0, 1.0, 2.0}}}}};
  const MotorParameters none(*robot, {}, DriveKind::revolute, believing);
  const std::vector<FileValue> file = none.in_file(none.believed());
  ASSERT_EQ(file.size(), robot->list().size() + 12);
  EXPECT_EQ(file[robot->list().size() + 3].value, 0.26);
  EXPECT_EQ(file.back().value, 0.0);
  ASSERT_EQ(none.believed_in_file().size(), file.size());
  EXPECT_EQ(none.believed_in_file().back().name, "drives.cogging_cosine_Nm[2]");
  EXPECT_EQ(none.believed_in_file().back().value, 2.0);
  EXPECT_EQ(none.stilled(), (std::vector<int>{0, 1, 2}));
  const MotorParameters one(*robot, {{.drive = 1, .rate = 24.0, .deviation = 1.0, .least = 10.0}},
                            DriveKind::revolute, believing);
  EXPECT_EQ(one.stilled(), (std::vector<int>{0, 2}));
}

TEST(MotorParameters, OfDrivesThatSlideAreInMetres) {
  const Hexapod hexapod(hexapod_robot());
  const auto robot = DynamicParameters::of(hexapod);
  const MotorParameters some(*robot, {{.drive = 5, .rate = 100.0, .deviation = 1.0, .least = 10.0}},
                             DriveKind::prismatic, default_drives(DriveKind::prismatic, 6));
  const std::vector<FileValue> file = some.in_file(some.believed());
  EXPECT_EQ(file[file.size() - 13].name, "drives.cogging_wavelength_m[5]");
  EXPECT_NEAR(file[file.size() - 13].value, 2.0 * std::numbers::pi / 100.0, 1e-15);
  EXPECT_EQ(file.back().name, "drives.cogging_cosine_N[5]");
}

// A torque that is behind its current by lambda leaves lambda times its slope.
TEST(MotorParameters, HaveTheSlopeOfItsTorqueForTheDelayOfADrive) {
  const auto robot = DynamicParameters::of(rig());
  const auto p = static_cast<Eigen::Index>(robot->list().size());
  DriveParameters believing = drives();
  believing.torque_delay = JointVector{{1e-4, 2e-4, 3e-4}};
  const MotorParameters parameters(*robot, {}, DriveKind::revolute, believing);
  DynamicsRows of_robot = cogging_rows(p);
  for (Eigen::Index row = 0; row < of_robot.slope.size(); ++row)
    of_robot.slope[row] = 1.0 + 0.5 * static_cast<double>(row);
  const DynamicsRows rows = parameters.rows(of_robot);
  ASSERT_EQ(rows.regressor.cols(), p + 3);
  for (Eigen::Index row = 0; row < rows.slope.size(); ++row) {
    for (int i = 0; i < 3; ++i)
      ASSERT_EQ(rows.regressor(row, p + i),
                rows.drive[static_cast<std::size_t>(row)] == i ? rows.slope[row] : 0.0);
  }
  Eigen::VectorXd values = parameters.believed();
  EXPECT_EQ(values[p + 1], 2e-4);
  values[p + 2] = 4e-4;
  const std::vector<FileValue> file = parameters.in_file(values);
  EXPECT_EQ(file.back().name, "drives.torque_delay_s[2]");
  EXPECT_EQ(file.back().value, 4e-4);
  EXPECT_EQ(file.back().mainly, std::vector{static_cast<int>(p + 2)});
}

// What was believed is what the waves make of the surplus.
TEST(MotorParameters, LeaveNoSurplusWhereTheyAreTrue) {
  const DynamicsRows rows = cogging_rows(0);
  Cogging known;
  for (const DriveWave& wave : truth) {
    known.waves.push_back({JointVector::Constant(3, 2.0 * std::numbers::pi / wave.rate),
                           wave.sine * JointVector::Unit(3, wave.drive),
                           wave.cosine * JointVector::Unit(3, wave.drive)});
  }
  const Eigen::VectorXd left = without_cogging(rows, known);
  EXPECT_LT(std::sqrt(left.squaredNorm() / static_cast<double>(left.size())), 1.1 * noise);
  EXPECT_EQ(without_cogging(rows, Cogging()), rows.surplus);
}

/// Of what the motors of a robot add about home, the share that a calibration does not find.
double not_found(const SimulatedScenario& scenario, const CalibrationResult& got, int drive) {
  const Cogging found = test::found_cogging(got, drive);
  const auto& harmonics = scenario.perturbed_robot.torque_ripple[static_cast<std::size_t>(drive)].cogging;
  const ParallelRobot& robot = *scenario.robot.robot;
  Kinematics home;
  robot.kinematics(robot.home_pose(), PlatformVector::Zero(robot.dof()), home);
  double left = 0.0, all = 0.0;
  for (double from_home = -0.4; from_home < 0.4; from_home += 0.01) {
    const double q = home.joints.active[drive] + from_home;
    double motor = 0.0;
    for (const PositionHarmonic& wave : harmonics) motor += wave.at(q);
    left += std::pow(found.at(JointVector::Constant(1, q))[0] - motor, 2);
    all += std::pow(motor, 2);
  }
  std::printf("  drive %d cogs by %.3f Nm, %.1f %% of it not found\n", drive + 1, harmonics[0].amplitude,
              100.0 * std::sqrt(left / all));
  return std::sqrt(left / all);
}

// What waves cannot be is left: torque ripple, and torque constants that are off.
TEST(Dynamics, FindHowTheMotorsOfARobotCog) {
  test::CalibratedRobot robot(1);
  robot.torque_constants("calibration_pulls.yaml");
  const SimulatedScenario scenario = robot.scenario("calibration_excitation.yaml");
  const CalibrationResult got = robot.dynamics("calibration_excitation.yaml");
  for (int drive = 0; drive < 3; ++drive) EXPECT_LT(not_found(scenario, got, drive), 0.1) << drive;
  EXPECT_LT(got.residual_after, 0.2 * got.residual_before);
  const Cogging taken_over = robot.scenario("calibration_motion.yaml").robot.drives.cogging;
  EXPECT_FALSE(taken_over.is_none()) << "by who reads it next";
}

// Of currents that follow their commands with a lag the mean over a tick is behind the end, by less than it.
TEST(Dynamics, FindHowFarTorquesAreBehindTheirCurrents) {
  for (const std::uint64_t seed : {1U, 2U}) {
    test::CalibratedRobot robot(seed);
    robot.torque_constants("calibration_pulls.yaml");
    const JointVector lag = robot.scenario("calibration_excitation.yaml").perturbed_robot.current_lag;
    robot.dynamics("calibration_excitation.yaml");
    const JointVector found = robot.scenario("calibration_motion.yaml").robot.drives.torque_delay;
    ASSERT_EQ(found.size(), 3);
    for (int drive = 0; drive < 3; ++drive) {
      constexpr double tick = 1e-3;
      const double delay = tick + lag[drive] - tick / (1.0 - std::exp(-tick / lag[drive]));
      std::printf("  drive %d is behind by %.3f ms, found %.3f ms\n", drive + 1, 1e3 * delay,
                  1e3 * found[drive]);
      EXPECT_NEAR(found[drive], delay, 0.02e-3);
    }
  }
}

// A robot that was calibrated once and is calibrated again: what is left before is what was left after.
TEST(Dynamics, FindTheSameCoggingAgain) {
  test::CalibratedRobot robot(1);
  robot.torque_constants("calibration_pulls.yaml");
  const CalibrationResult first = robot.dynamics("calibration_excitation.yaml");
  const CalibrationResult again = robot.dynamics("calibration_excitation.yaml");
  EXPECT_NEAR(again.residual_before, first.residual_after, 0.1 * first.residual_after);
  EXPECT_NEAR(again.residual_after, first.residual_after, 0.1 * first.residual_after);
  for (const CalibratedParameter& parameter : again.parameters) {
    if (parameter.name.starts_with("drives.torque_delay")) {
      ASSERT_TRUE(parameter.before.has_value());
      EXPECT_GT(std::abs(*parameter.before), 0.02e-3);
      EXPECT_NEAR(parameter.value, *parameter.before, 2e-6);
    }
    if (parameter.name.starts_with("drives.cogging_sine")) {
      ASSERT_TRUE(parameter.before.has_value());
      EXPECT_NEAR(parameter.value, *parameter.before, 0.02);
    }
  }
}

TEST(Dynamics, FindNoCoggingWhereThereIsNone) {
  test::CalibratedRobot robot(1);
  const CalibrationResult got =
      robot.dynamics("calibration_excitation.yaml", {{test::excitation_realism, test::only_parameters}});
  for (const CalibratedParameter& parameter : got.parameters)
    EXPECT_FALSE(parameter.name.starts_with("drives.cogging")) << parameter.name;
}

}  // namespace
}  // namespace flinch
