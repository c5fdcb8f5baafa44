#pragma once

#include <memory>
#include <optional>

#include "systems/framework/time.h"
#include "systems/robot/imu_mount.h"
#include "systems/robot/parallel_robot.h"

/// What the robot tells once a millisecond, in units and signs of the robot file.
struct MyReadings {
  flinch::JointVector active;                        ///< encoders of the drives [rad]
  flinch::JointVector passive;                       ///< encoders of the elbows [rad]
  flinch::JointVector current;                       ///< [A]
  Eigen::Vector3d angular_velocity, specific_force;  ///< of the IMU, in its axes [rad/s, m/s^2]
  bool braked = true;
};

/// A robot within this program: THIS CLASS IS YOURS. It may talk to a motion card, to another simulator, or
/// to a robot of another make. What stands in this file now is a small simulation of its own, with a wall.
class MyRobot {
 public:
  MyRobot(std::shared_ptr<const flinch::ParallelRobot> robot, flinch::Configuration pose,
          flinch::JointVector torque_constant, const flinch::MountedImu& imu);

  MyReadings read() const;
  /// A millisecond with this torque [Nm]; none: brakes.
  void advance(const std::optional<flinch::JointVector>& torque);

  /// When the wall was first touched; none: not yet.
  std::optional<flinch::Time> touched() const { return touched_; }
  bool touches() const { return wall_force() > 0.0; }

 private:
  double wall_force() const;

  std::shared_ptr<const flinch::ParallelRobot> robot_;
  flinch::Configuration pose_;
  flinch::PlatformVector velocity_, acceleration_;
  flinch::JointVector torque_constant_, torque_;
  flinch::MountedImu imu_;
  bool braked_ = true;
  flinch::Time time_{};
  std::optional<flinch::Time> touched_;
};
