#pragma once

#include <Eigen/Core>

#include "systems/robot/configuration_space.h"

namespace flinch {

/// How the platform moves as a body in space, whatever its coordinates are; a planar one moves in the plane
/// z = 0. Base frame.
struct SpatialMotion {
  Eigen::Matrix3d axes;                  ///< R: from platform axes to the base frame.
  Eigen::Vector3d acceleration;          ///< Of the platform's origin [m/s^2].
  Eigen::Vector3d angular_velocity;      ///< [rad/s]
  Eigen::Vector3d angular_acceleration;  ///< [rad/s^2]
};

/// The motion at `pose` with these derivatives, all of which must have the sizes of `space`.
SpatialMotion spatial_motion(const ConfigurationSpace& space, const Configuration& pose,
                             const PlatformVector& velocity, const PlatformVector& acceleration) noexcept;

}  // namespace flinch
