#pragma once

#include <Eigen/Core>

#include "systems/robot/configuration_space.h"
#include "systems/robot/imu_mount.h"

namespace flinch {

/// What an ideal IMU on the platform measures, and how that changes with the platform's motion: angular
/// velocity [rad/s], then specific force [m/s^2], in the sensor's frame. [RAL25] (8), (9)
struct ImuOutput {
  using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, max_dof>;

  Eigen::Matrix<double, 6, 1> value;
  Jacobian by_pose;  ///< by increments of the pose, as `ConfigurationSpace::plus` adds them
  Jacobian by_velocity;
  Jacobian by_acceleration;
};

/// The output at a motion, all of which must have the sizes of `space`. `gravity` in the base frame [m/s^2].
ImuOutput imu_output(ConfigurationSpace space, const MountedImu& imu, const Eigen::Vector3d& gravity,
                     const Configuration& pose, const PlatformVector& velocity,
                     const PlatformVector& acceleration) noexcept;

}  // namespace flinch
