#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/drive_torque.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/sampling.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

struct DisturbanceFilterSettings {
  double pole = 300.0;              ///< threefold [1/s]
  double encoder_deviation = 7e-6;  ///< of a sample [rad, or m of drives that slide]
  Sampling sampling;

  friend bool operator==(const DisturbanceFilterSettings&, const DisturbanceFilterSettings&) = default;
};

/// What the disturbance filter remembers, one entry a drive.
struct DisturbanceFilterMemory {
  bool started = false;
  bool braked = false;
  Time acquired{};
  Time arrived{};  ///< tick at which the last sample was read
  Time since{};    ///< tick of the first one
  JointVector position;
  JointVector velocity;
  JointVector error;  ///< acceleration that the model does not explain [rad/s^2 or m/s^2]
  double innovation = 1.0;
  Configuration pose;
  PlatformMatrix J_x_qa;
};

/// Finds in the encoders alone what the model does not explain. For each drive it follows position, velocity
/// and the error d of the acceleration that the model predicts from the torques,
///   ddq = ddq_model(x, dx, tau) + d,
/// by a filter with a threefold pole exp(-pole T); then F_ext = M_x J_x_qa d. (Derived.)
///
/// The model is evaluated at the velocity that the filter itself follows, in the middle of the step over
/// which the drives held the torque: nothing in it lags as a differentiated and filtered velocity does. So
/// `torque` must not be filtered, and the velocity of `kinematics` is not used.
///
/// Samples that are missing or broken and closed brakes are treated as by `MomentumEstimator`. Drives that
/// brakes held until now begin at rest, unless their rates are larger than noise: the noise would be an error
/// of the model for 10 ms.
class DisturbanceFilter final : public System {
  State<DisturbanceFilterMemory> memory_ = state<DisturbanceFilterMemory>("memory");

 public:
  /// Throws SetupError for settings that are not positive.
  DisturbanceFilter(std::shared_ptr<const ParallelRobot> robot, const DisturbanceFilterSettings& settings);

  InputPort<JointReading> joints = input<JointReading>("joints");
  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");
  InputPort<DriveTorque> torque = input<DriveTorque>("torque");

 private:
  Intermediate<DisturbanceFilterMemory> next_ =
      intermediate<&DisturbanceFilter::advance>("next", joints, platform, kinematics, torque, memory_, clock);

 public:
  /// The platform with the velocity that the filter follows, which lags less than one that is low-passed.
  OutputPort<PlatformMotion> followed =
      output<&DisturbanceFilter::follow>("followed", next_, platform, kinematics);
  OutputPort<WrenchEstimate> wrench =
      output<&DisturbanceFilter::read>("wrench", next_, kinematics, dynamics, clock);

 private:
  void advance(const JointReading& reading, const PlatformMotion& motion, const Kinematics& at,
               const DriveTorque& drives, const DisturbanceFilterMemory& memory, Time now,
               DisturbanceFilterMemory& next) const;
  void follow(const DisturbanceFilterMemory& next, const PlatformMotion& measured, const Kinematics& at,
              PlatformMotion& result) const;
  void read(const DisturbanceFilterMemory& next, const Kinematics& at, const Dynamics& model, Time now,
            WrenchEstimate& result) const;
  bool is_usable(const JointReading& reading, const PlatformMotion& motion, const Kinematics& at,
                 const DriveTorque& drives) const;
  void step(const DisturbanceFilterMemory& memory, const JointVector& position, const JointVector& torque,
            double T, DisturbanceFilterMemory& next) const;
  JointVector modelled_acceleration(const DisturbanceFilterMemory& memory, const JointVector& torque,
                                    double T) const;

  std::shared_ptr<const ParallelRobot> robot_;
  DisturbanceFilterSettings settings_;
  double error_deviation_;       ///< of d, where only the encoders err [rad/s^2 or m/s^2]
  double innovation_deviation_;  ///< likewise [rad or m]
  double resting_rate_;          ///< below which a rate is noise [rad/s or m/s]
  double observability_;
  Time settling_time_;
};

}  // namespace flinch
