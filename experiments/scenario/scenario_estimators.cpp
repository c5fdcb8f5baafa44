#include "experiments/scenario/scenario_estimators.h"

#include <cmath>
#include <span>

#include "diagrams/contact_control_settings.h"
#include "experiments/scenario/largest_stamp_spread.h"
#include "systems/config/config_reader.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

/// Gains and poles: slower than any experiment lasts, to faster than ticks follow one another.
constexpr Range of_a_loop = between(1e-3, 1e4);  // [1/s]
/// Deviations, densities and rates, whatever their unit: beyond, an estimate is no more than rounding.
constexpr Range within_reason = between(1e-12, 1e12);

/// What is left to the robot's size is written out, so that a file can change one entry.
void read(ConfigReader reader, const ParallelRobot& robot, MomentumObserverSettings& settings) {
  if (settings.gain.size() == 0) settings.gain.setConstant(robot.dof(), 20.0);
  const std::span<double> gain(settings.gain.data(), static_cast<std::size_t>(settings.gain.size()));
  reader.numbers("gain", unit::per_s, gain, of_a_loop);
}

void read(ConfigReader reader, MomentumKalmanFilterSettings& settings) {
  reader.number("momentum_deviation", unit::Ns, settings.translation.momentum_deviation, within_reason);
  reader.number("angular_momentum_deviation", unit::Nms, settings.rotation.momentum_deviation, within_reason);
  reader.number("force_density", unit::N2_per_s, settings.translation.force_density, within_reason);
  reader.number("moment_density", unit::N2m2_per_s, settings.rotation.force_density, within_reason);
}

void read(ConfigReader reader, SlidingModeObserverSettings& settings) {
  reader.number("force_rate", unit::N_per_s, settings.force_rate, within_reason);
  reader.number("moment_rate", unit::Nm_per_s, settings.moment_rate, within_reason);
  reader.number("damping", unit::per_s, settings.damping, of_a_loop);
  reader.integer("substeps", settings.substeps, 1, 100);
}

void read(ConfigReader reader, ImuMount& mount) {
  reader.numbers("position", unit::m, {mount.position_in_platform.data(), 3});
  reader.numbers("angles", unit::rad, {mount.angles.data(), 3});
}

/// A variance, which a file gives by its root; untouched where that is not changed.
void read_deviation(ConfigReader& reader, const char* name, const Unit& unit, double& variance) {
  const double before = std::sqrt(variance);
  double deviation = before;
  reader.number(name, unit, deviation, within_reason);
  if (deviation != before) variance = deviation * deviation;
}

void read(ConfigReader reader, ImuFilterSettings& settings) {
  ImuFilterNoise& noise = settings.noise;
  read_deviation(reader, "position_deviation", unit::m, noise.encoder_pose.translation);
  read_deviation(reader, "orientation_deviation", unit::rad, noise.encoder_pose.rotation);
  read_deviation(reader, "gyroscope_deviation", unit::rad_per_s, noise.gyroscope);
  read_deviation(reader, "accelerometer_deviation", unit::m_per_s2, noise.accelerometer);
  read_deviation(reader, "acceleration_change", unit::m_per_s2, noise.acceleration.translation);
  read_deviation(reader, "angular_acceleration_change", unit::rad_per_s2, noise.acceleration.rotation);
  reader.number("largest_innovation", unit::none, settings.largest_innovation, within_reason);
}

void read(ConfigReader reader, const ParallelRobot& robot, DisturbanceFilterSettings& settings) {
  const bool turns = robot.drive_kind(0) == DriveKind::revolute;
  reader.number("pole", unit::per_s, settings.pole, of_a_loop);
  reader.number("encoder_deviation", turns ? unit::rad : unit::m, settings.encoder_deviation, within_reason);
}

void read(ConfigReader reader, ImuResidualSettings& settings) {
  reader.number("gyroscope_gain", unit::per_s, settings.gyroscope_gain, of_a_loop);
  reader.number("gyroscope_deviation", unit::rad_per_s, settings.gyroscope_deviation, within_reason);
  reader.number("accelerometer_deviation", unit::m_per_s2, settings.accelerometer_deviation, within_reason);
  reader.duration("jitter", settings.jitter, not_negative);
}

}  // namespace

void read_estimators(ConfigReader& control, const ParallelRobot& robot, ContactControlSettings& settings) {
  read(control.section("momentum_observer"), robot, settings.momentum_observer);
  read(control.section("momentum_kalman_filter"), settings.momentum_kalman_filter);
  read(control.section("sliding_mode_observer"), settings.sliding_mode_observer);
  read(control.section("disturbance_filter"), robot, settings.disturbance_filter);
  read(control.section("imu_mount"), settings.imu_mount);
  control.section("imu_stamps")
      .duration("spread", settings.imu_stamp_spread, between(0.0, to_seconds(largest_stamp_spread)));
  read(control.section("imu_ekf"), settings.imu_ekf);
  read(control.section("extended_imu_ekf"), settings.extended_imu_ekf);
  read(control.section("unscented_imu_filter"), settings.unscented_imu_filter);
  read(control.section("imu_residual"), settings.imu_residual);
}

}  // namespace flinch
