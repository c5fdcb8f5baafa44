#pragma once

#include <Eigen/Core>
#include <numbers>

#include "systems/robot/spatial_motion.h"

namespace flinch {

/// Where an inertial measurement unit sits on the platform, frame E, and how it is turned.
struct ImuMount {
  Eigen::Vector3d position_in_platform{-0.005, 0.001, -0.097};  ///< p_S [m], [RAL25] V-B
  /// Turns about x, then y, then z of the turned frames that take the platform's axes to the sensor's, S
  /// [rad].
  Eigen::Vector3d angles{2.8 * degree, -5.2 * degree, 2.3 * degree};

 private:
  static constexpr double degree = std::numbers::pi / 180.0;
};

/// R_SE: from platform to sensor axes.
Eigen::Matrix3d platform_to_sensor(const ImuMount& mount) noexcept;

/// A mount whose rotation is worked out once, for those who need it at every tick.
struct MountedImu {
  MountedImu(const ImuMount& mount) noexcept  // NOLINT(google-explicit-constructor)
      : position_in_platform(mount.position_in_platform), to_sensor(platform_to_sensor(mount)) {}

  Eigen::Vector3d position_in_platform;  ///< p_S [m]
  Eigen::Matrix3d to_sensor;             ///< R_SE
};

/// Acceleration minus gravity of a point fixed to the platform, in platform axes [m/s^2]. [RAL25] (8)
Eigen::Vector3d specific_force(const SpatialMotion& now, const Eigen::Vector3d& point_in_platform,
                               const Eigen::Vector3d& gravity) noexcept;

}  // namespace flinch
