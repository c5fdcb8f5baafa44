#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "plant/delay_line.h"
#include "plant/plant_truth.h"
#include "plant/sensor_noise.h"
#include "systems/framework/system.h"
#include "systems/robot/imu_mount.h"
#include "systems/robot/mechanism.h"
#include "systems/robot/spatial_motion.h"
#include "systems/signals/imu_reading.h"

namespace flinch {

/// An inertial measurement unit on the platform. The defaults are the BMI160 at pose 1 of [RAL25] IV-A, V-B.
struct SimulatedImuSettings {
  bool ideal = false;  ///< Readings are the truth, at once.

  Eigen::Vector3d position_in_platform{-0.005, 0.001, -0.097};  ///< p_S [m]
  /// Turns about x, then y, then z of the turned frames that take the platform's axes to the sensor's [rad].
  Eigen::Vector3d angles{2.8 * degree, -5.2 * degree, 2.3 * degree};
  ImuMount mount() const { return {position_in_platform, angles}; }

  double accelerometer_density = 180e-6 * standard_gravity;  ///< Noise [m/s^2/sqrt(Hz)].
  double gyroscope_density = 0.007 * degree;                 ///< [rad/s/sqrt(Hz)]
  /// Each axis has a constant one of at most this [m/s^2].
  double accelerometer_bias = 0.04 * standard_gravity;
  double gyroscope_bias = 3.0 * degree;            ///< [rad/s]
  double accelerometer_resolution = 2.99e-4;       ///< [m/s^2]
  double gyroscope_resolution = 1.91e-3 * degree;  ///< [rad/s]

  Time period = 1ms;
  /// How long before a tick it measures: its clock is its own. Shorter than the period.
  Time before_tick = 0us;
  Time delay = 3500us;  ///< From measurement to delivery, at the first tick thereafter.

 private:
  static constexpr double degree = std::numbers::pi / 180.0;
  static constexpr double standard_gravity = 9.80665;
};

std::vector<std::string> problems(const SimulatedImuSettings& settings);

/// Measures angular velocity and specific force at p_S, in its own axes, every period. What it delivers later
/// is stamped with the time of measurement; before the first sample is through, its output is not valid. What
/// it measures before a tick is the motion of the tick, back under the acceleration that has led there.
class SimulatedImu final : public System {
 public:
  /// Throws SetupError.
  SimulatedImu(const SimulatedImuSettings& settings, const Mechanism& robot, std::uint64_t seed);

  const Eigen::Vector3d& accelerometer_bias() const { return accelerometer_bias_; }
  const Eigen::Vector3d& gyroscope_bias() const { return gyroscope_bias_; }

 private:
  SimulatedImuSettings settings_;
  ConfigurationSpace space_;
  Eigen::Vector3d gravity_;
  Eigen::Matrix3d R_SE_;  // from platform to sensor axes
  Eigen::Vector3d accelerometer_bias_;
  Eigen::Vector3d gyroscope_bias_;
  State<NormalNumbers<6>> noise_;
  State<DelayLine<ImuReading>> underway_ = state<DelayLine<ImuReading>>("underway");

 public:
  InputPort<PlantTruth> truth = input<PlantTruth>("truth");

 private:
  Intermediate<ImuReading> measured_ = intermediate<&SimulatedImu::measure>("measured", truth, noise_);

 public:
  OutputPort<ImuReading> imu = output<&SimulatedImu::deliver>("imu", clock, measured_, underway_);

 private:
  Update draw_ = update<&SimulatedImu::draw>(noise_);
  Update send_ = update<&SimulatedImu::send>(Every{settings_.period}, underway_, measured_);

  SpatialMotion motion_before(const PlantTruth& now, double seconds) const;
  void measure(const PlantTruth& now, const NormalNumbers<6>& noise, ImuReading& reading) const;
  void deliver(Time now, const ImuReading& fresh, const DelayLine<ImuReading>& underway,
               ImuReading& reading) const;
  void send(const ImuReading& fresh, DelayLine<ImuReading>& underway) const { underway.push(fresh); }
  void draw(NormalNumbers<6>& noise) const { noise.draw(); }
};

}  // namespace flinch
