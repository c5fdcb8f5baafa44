#pragma once

#include <Eigen/Core>
#include <memory>

#include "systems/framework/system.h"
#include "systems/robot/imu_output.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/drive_torque.h"
#include "systems/signals/history.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/sampling.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

struct ImuResidualSettings {
  ImuMount mount;
  double gyroscope_gain = 300.0;            ///< of the observer of what turns the platform [1/s]
  double gyroscope_deviation = 2.74e-3;     ///< of a sample [rad/s]
  double accelerometer_deviation = 0.0395;  ///< of a sample [m/s^2]
  Time jitter = 300us;                      ///< deviation of the times at which the IMU says that it measured
  Time stamp_spread{};                      ///< width of the range in which they err, evenly; 0: not stated
  double rest_speed = 0.01;                 ///< below which the platform rests [m/s]
  double rest_rate = 0.05;                  ///< likewise [rad/s]
  /// As slow in so many samples in a row, it rests: a platform that turns back is slow for fewer.
  int rest_in_a_row = 50;
  int leaving_rest = 25;  ///< the last samples of a rest may be a start, and do not count
  int rest_samples = 50;  ///< at rest, before the biases are known
  /// Above this mean innovation something is wrong with the IMU, and the estimate is not valid.
  double largest_innovation = 10.0;
  Sampling sampling;
};

/// What the model expects of an instant.
struct ExpectedMotion {
  Time acquired{};
  bool valid = false;
  bool braked = false;
  bool is_slow = false;                          ///< as if it rested
  Eigen::Vector3d force_at_rest{0.0, 0.0, 0.0};  ///< what the accelerometer measures of gravity [m/s^2]
  Eigen::Vector3d force{0.0, 0.0, 0.0};          ///< and under the acceleration of the model [m/s^2]
  Eigen::Vector3d rotation{0.0, 0.0, 0.0};       ///< dw/dt under it, sensor axes [rad/s^2]
  ImuOutput::Jacobian by_acceleration;  ///< how dw/dt and specific force change with the acceleration
  PlatformMatrix M_x;
  PlatformVector driving;  ///< F_a [N, Nm]
};

/// What an accelerometer measures beside gravity, as a mean over samples at rest.
struct AccelerometerBias {
  int samples = 0;
  Eigen::Vector3d value{0.0, 0.0, 0.0};  ///< Sensor axes [m/s^2].
};

/// What the residual of the IMU remembers.
struct ImuResidualMemory {
  bool started = false;
  bool sees_imu = false;                             ///< in the last tick
  Time acquired = Time::min();                       ///< of the last reading
  Time arrived{};                                    ///< tick at which it was read
  int slow = 0;                                      ///< samples in a row in which the platform was slow
  AccelerometerBias bias, earlier, latest;           ///< that counts, and as learned since
  Eigen::Vector3d angular_velocity{0.0, 0.0, 0.0};   ///< last reading [rad/s]
  Eigen::Vector3d expected_force{0.0, 0.0, 0.0};     ///< last expectation [m/s^2]
  Eigen::Vector3d rotation_residual{0.0, 0.0, 0.0};  ///< dw/dt that nothing explains [rad/s^2]
  bool braked = false;
  PlatformVector wrench;
  PlatformVector standard_deviation;
  double innovation = 1.0;  ///< mean of late, see `EstimatorHealth`
};

/// Compares accelerometer and gyroscope with what the model expects of the time at which they measured: with
/// the acceleration that drive torques and model give, of some milliseconds ago; of a sample between two
/// ticks, on the straight line between them, but for the torque, see `driven_share`. What is left is an
/// acceleration that the surroundings cause, and F_ext = M_x times it. (Derived.)
///
/// The accelerometer is not filtered. Of the gyroscope, the change between samples is what counts, seen
/// through an observer as that of the momentum: r_k = a r_{k-1} + (1 - a) ((w_k - w_{k-1}) / T - mean of
/// dw/dt_model since then). Both together give the acceleration by least squares, each weighed by its noise;
/// that of the accelerometer grows with the slope of what is expected, for a wrong time of the sample is its
/// largest error.
///
/// Where the platform has fewer coordinates than the unit has axes, no acceleration of it explains all that
/// they say: what is left, of which the mean square over its variance should be 1, monitors the unit.
///
/// The accelerometer's bias is learned where the platform rests: there it measures gravity alone, whoever
/// touches the robot. Until then, and in a tick without a valid reading, the estimate is not valid. Zero
/// while brakes are closed. `torque` must not be filtered.
class ImuResidual final : public System {
  State<ImuResidualMemory> memory_ = state<ImuResidualMemory>("memory");
  State<History<ExpectedMotion, late_samples>> past_ = state<History<ExpectedMotion, late_samples>>("past");

 public:
  /// Throws SetupError for settings that are not positive.
  ImuResidual(std::shared_ptr<const ParallelRobot> robot, const ImuResidualSettings& settings);

  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");
  InputPort<DriveTorque> torque = input<DriveTorque>("torque");
  InputPort<ImuReading> imu = input<ImuReading>("imu");

 private:
  Intermediate<ExpectedMotion> expected_ =
      intermediate<&ImuResidual::expect>("expected", platform, kinematics, dynamics, torque);
  Intermediate<ImuResidualMemory> next_ =
      intermediate<&ImuResidual::advance>("next", imu, expected_, past_, memory_, clock);

 public:
  OutputPort<WrenchEstimate> wrench = output<&ImuResidual::read>("wrench", next_, expected_, kinematics);

 private:
  Update remember_ = update<&ImuResidual::remember>(past_, expected_);

  void expect(const PlatformMotion& motion, const Kinematics& at, const Dynamics& model,
              const DriveTorque& drives, ExpectedMotion& result) const;
  void remember(const ExpectedMotion& fresh, History<ExpectedMotion, late_samples>& past) const;
  void advance(const ImuReading& reading, const ExpectedMotion& fresh,
               const History<ExpectedMotion, late_samples>& past, const ImuResidualMemory& memory, Time now,
               ImuResidualMemory& next) const;
  void read(const ImuResidualMemory& next, const ExpectedMotion& fresh, const Kinematics& at,
            WrenchEstimate& result) const;
  bool is_usable(const ImuReading& reading) const;
  void learn_bias(const ImuReading& reading, const ExpectedMotion& then, ImuResidualMemory& next) const;
  void turn(const ImuReading& reading, const ExpectedMotion& then, double T, ImuResidualMemory& next) const;
  void estimate(const ImuReading& reading, const ExpectedMotion& then, double T,
                ImuResidualMemory& next) const;

  std::shared_ptr<const ParallelRobot> robot_;
  ImuResidualSettings settings_;
  MountedImu imu_;
};

}  // namespace flinch
