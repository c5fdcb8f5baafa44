#pragma once

#include <Eigen/Core>
#include <memory>

#include "systems/estimators/error_covariance.h"
#include "systems/framework/system.h"
#include "systems/robot/imu_output.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/history.h"
#include "systems/signals/imu_bias.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/platform_acceleration.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/sampling.h"

namespace flinch {

/// A quantity of translations and of rotations.
struct TwoKinds {
  double translation;
  double rotation;
};

/// Variances that a filter of IMU and encoders believes in; those of sensors are for each sample, those of
/// motions and biases are added in each millisecond.
struct ImuFilterNoise {
  TwoKinds encoder_pose;      ///< [m^2, rad^2]
  double gyroscope;           ///< [rad^2/s^2]
  double accelerometer;       ///< [m^2/s^4]
  TwoKinds pose;              ///< [m^2, rad^2]
  TwoKinds velocity;          ///< [m^2/s^2, rad^2/s^2]
  TwoKinds acceleration;      ///< [m^2/s^4, rad^2/s^4]
  double gyroscope_bias;      ///< not used where biases are not estimated [rad^2/s^2]
  double accelerometer_bias;  ///< likewise [m^2/s^4]
};

struct ImuFilterSettings {
  ImuMount mount;
  Time stamp_spread{};  ///< Width of the range in which stamps of the IMU err, evenly; 0: not stated.
  ImuFilterNoise noise;
  /// Variances at the beginning, in the units of `ImuFilterNoise`.
  TwoKinds initial_pose, initial_velocity, initial_acceleration;
  double initial_gyroscope_bias = 0.0, initial_accelerometer_bias = 0.0;
  /// Whether the IMU has biases that wander.
  bool estimates_biases = false;
  /// Whether a sample of the IMU is taken with the pose of the time at which it was acquired. Then the
  /// acceleration is that of then. If not, both are taken to be of now, as in the paper.
  bool aligned = false;
  /// Whether what the IMU should measure is taken at points about the states, and not linear about them.
  bool unscented = false;
  /// Above this mean innovation something is wrong with the IMU, and the acceleration is not valid.
  double largest_innovation = 10.0;
  Time settling_time = 100ms;
  Sampling sampling;
};

/// As printed, [RAL25] (6)-(11).
ImuFilterSettings published_imu_filter();
/// With biases, the sensors' own noise and aligned.
ImuFilterSettings extended_imu_filter();
/// The same, unscented.
ImuFilterSettings unscented_imu_filter();

/// What a filter of IMU and encoders remembers.
struct ImuFilterMemory {
  static constexpr int states = 3 * max_dof + 6;  ///< most: pose, velocity, acceleration, biases

  bool started = false;
  bool sees_imu = false;                 ///< in the last tick
  Time measured = Time::min();           ///< when the IMU acquired its last reading
  Eigen::Vector3d force{0.0, 0.0, 0.0};  ///< which that was [m/s^2]
  Time time{};                           ///< of the states
  Time arrived{};                        ///< tick at which the last sample was read
  Time since{};                          ///< tick of the first one
  Configuration pose;
  PlatformVector velocity;
  PlatformVector acceleration;
  ImuBias bias;  ///< valid where the filter estimates it
  ErrorCovariance<states> errors;
  double innovation = 1.0;
};

/// A pose that the encoders told.
struct PoseSample {
  Time acquired{};
  Configuration pose;
};

/// Extended Kalman filter of an IMU on the platform and of the pose that the encoders tell, for the
/// platform's acceleration. [RAL25] (6)-(9), Alg. 1. Or unscented: how the IMU's output changes with the
/// states is then a mean over points about them, as far away as they are uncertain.
///
/// States are pose, velocity and constant acceleration, perhaps biases of gyroscope and accelerometer; poses
/// are added and subtracted on their manifold, so that it serves any mechanism. The output is the pose,
/// angular velocity and specific force in the sensor's frame. Covariances are updated in Joseph's form.
///
/// The acceleration is not valid while the filter settles, in a tick without a valid reading of the IMU, and
/// where the innovations are larger than they should be. A reading that is repeated is held for the longest
/// hold; after that, and after an interruption, the filter begins anew.
class ImuFilter final : public System {
  ImuFilterSettings settings_;
  State<ImuFilterMemory> memory_ = state<ImuFilterMemory>("memory");
  State<History<PoseSample, late_samples>> poses_ = state<History<PoseSample, late_samples>>("poses");

 public:
  /// Throws SetupError for noise that is not positive.
  ImuFilter(std::shared_ptr<const ParallelRobot> robot, const ImuFilterSettings& settings);

  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  InputPort<ImuReading> imu = input<ImuReading>("imu");

 private:
  Intermediate<ImuFilterMemory> next_ =
      intermediate<&ImuFilter::advance>("next", platform, imu, poses_, memory_, clock);

 public:
  /// Reciprocal condition number of the observability matrix, ten times a second.
  OutputPort<double> observability = output<&ImuFilter::observe>(
      Every{whole_periods(100ms, settings_.sampling.period)}, "observability", next_);
  OutputPort<ImuBias> bias = output<&ImuFilter::tell_bias>("bias", next_);
  OutputPort<PlatformAcceleration> acceleration =
      output<&ImuFilter::read>("acceleration", next_, observability, clock);

 private:
  Update remember_ = update<&ImuFilter::remember>(poses_, platform);

  using Errors = ErrorCovariance<ImuFilterMemory::states>;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_dof + 6, ImuFilterMemory::states>;

  void advance(const PlatformMotion& motion, const ImuReading& reading,
               const History<PoseSample, late_samples>& poses, const ImuFilterMemory& memory, Time now,
               ImuFilterMemory& next) const;
  void remember(const PlatformMotion& motion, History<PoseSample, late_samples>& poses) const;
  double observe(const ImuFilterMemory& next) const;
  ImuBias tell_bias(const ImuFilterMemory& next) const { return next.bias; }
  void read(const ImuFilterMemory& next, double observable, Time now, PlatformAcceleration& result) const;

  bool is_usable(const ImuReading& reading) const;
  ImuFilterMemory waiting(const ImuFilterMemory& memory, Time now) const;
  PoseSample pose_for(const ImuReading& reading, const PlatformMotion& motion,
                      const History<PoseSample, late_samples>& poses) const;
  void begin(const PoseSample& pose, const PlatformMotion& motion, Time now, ImuFilterMemory& next) const;
  void predict(double T, ImuFilterMemory& next) const;
  void correct(const PoseSample& pose, const ImuReading& reading, double T, ImuFilterMemory& next) const;
  TwoKinds by_stamps(const ImuOutput& expected, const ImuReading& reading, double T,
                     const ImuFilterMemory& states) const;
  ImuOutput output_at(const ImuFilterMemory& states) const;
  /// What the IMU should measure, without its biases, and how that changes with the states.
  struct ImuPrediction {
    Eigen::Matrix<double, 6, 1> value;
    Rows C;
    Eigen::Matrix<double, 6, 1> bending;  ///< variance that no linear change explains
  };
  void spread_out(const ImuFilterMemory& states, ImuPrediction& prediction) const;
  void add(const Errors::Vector& change, ImuFilterMemory& states) const;
  Rows output_matrix(const ImuOutput& sensed) const;
  double of(const TwoKinds& kinds, int coordinate) const {
    return coordinate < robot_->space().translations() ? kinds.translation : kinds.rotation;
  }

  std::shared_ptr<const ParallelRobot> robot_;
  MountedImu imu_;
  int n_, states_;
};

}  // namespace flinch
