#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "plant/delay_line.h"
#include "plant/imu_clock.h"
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
  /// Each axis has a constant one of at most this [m/s^2], drawn where it is not `fixed_accelerometer_bias`.
  double accelerometer_bias = 0.04 * standard_gravity;
  std::optional<Eigen::Vector3d> fixed_accelerometer_bias{};  ///< In the sensor's axes [m/s^2].
  double gyroscope_bias = 3.0 * degree;                       ///< [rad/s]
  double accelerometer_resolution = 2.99e-4;                  ///< [m/s^2]
  double gyroscope_resolution = 1.91e-3 * degree;             ///< [rad/s]

  ImuClockSettings clock;
  Time delay = 3500us;  ///< From measurement to delivery, at the first tick thereafter.

 private:
  static constexpr double degree = std::numbers::pi / 180.0;
  static constexpr double standard_gravity = 9.80665;
};

std::vector<std::string> problems(const SimulatedImuSettings& settings);

/// What an IMU has measured since the tick before, the latest last.
struct ImuSamples {
  static constexpr int most = 17;  ///< in a tick of 16 periods, some early, some late
  struct Sample {
    Time acquired{};  ///< When it was measured, or would have been to come now with the usual delay.
    ImuReading reading;
  };

  std::array<Sample, most> samples;
  int count = 0;
};

/// Measures angular velocity and specific force at p_S, in its own axes, by its own clock. At each tick the
/// newest sample that has come through is there, stamped with the time of measurement; one that was there
/// before where none has come. Before the first sample is through, the output is not valid. What it measures
/// before a tick is the motion of the tick, back under the acceleration that has led there.
class SimulatedImu final : public System {
 public:
  /// `tick` is the time between ticks of the diagram, or a multiple of it. Throws SetupError.
  SimulatedImu(const SimulatedImuSettings& settings, const Mechanism& robot, std::uint64_t seed,
               Time tick = 1ms);

  const Eigen::Vector3d& accelerometer_bias() const { return accelerometer_bias_; }
  const Eigen::Vector3d& gyroscope_bias() const { return gyroscope_bias_; }

 private:
  SimulatedImuSettings settings_;
  Time tick_;
  ImuClock clock_;
  ConfigurationSpace space_;
  Eigen::Vector3d gravity_;
  Eigen::Matrix3d R_SE_;  // from platform to sensor axes
  Eigen::Vector3d accelerometer_bias_;
  Eigen::Vector3d gyroscope_bias_;
  State<NormalNumbers<6>> noise_;
  State<DelayLine<ImuSamples::Sample>> underway_ = state<DelayLine<ImuSamples::Sample>>("underway");

 public:
  InputPort<PlantTruth> truth = input<PlantTruth>("truth");

 private:
  Intermediate<ImuSamples> measured_ = intermediate<&SimulatedImu::measure>("measured", truth, noise_);

 public:
  OutputPort<ImuReading> imu = output<&SimulatedImu::deliver>("imu", clock, measured_, underway_);

 private:
  Update draw_ = update<&SimulatedImu::draw>(noise_, measured_);
  Update send_ = update<&SimulatedImu::send>(underway_, measured_);

  SpatialMotion motion_before(const PlantTruth& now, double seconds) const;
  void read(const PlantTruth& now, Time before, const NormalNumbers<6>& noise, ImuReading& reading) const;
  void measure(const PlantTruth& now, const NormalNumbers<6>& noise, ImuSamples& measured) const;
  void deliver(Time now, const ImuSamples& fresh, const DelayLine<ImuSamples::Sample>& underway,
               ImuReading& reading) const;
  void send(const ImuSamples& fresh, DelayLine<ImuSamples::Sample>& underway) const;
  void draw(const ImuSamples& fresh, NormalNumbers<6>& noise) const;
};

}  // namespace flinch
