#include "systems/robot/spatial_motion.h"

#include <cmath>

#include "systems/robot/rotation.h"

namespace flinch {
namespace {

Eigen::Matrix3d axes_of(const ConfigurationSpace& space, const Configuration& pose) {
  if (space.rotations() == 3) return rotation_matrix(pose.tail<4>());
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (space.rotations() == 0) return axes;
  const double angle = pose[space.translations()];
  axes.topLeftCorner<2, 2>() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return axes;
}

Eigen::Vector3d translation(const ConfigurationSpace& space, const PlatformVector& v) {
  Eigen::Vector3d full = Eigen::Vector3d::Zero();
  full.head(space.translations()) = v.head(space.translations());
  return full;
}

// A single axis of rotation is z.
Eigen::Vector3d rotation(const ConfigurationSpace& space, const PlatformVector& v) {
  Eigen::Vector3d full = Eigen::Vector3d::Zero();
  full.tail(space.rotations()) = v.tail(space.rotations());
  return full;
}

}  // namespace

SpatialMotion spatial_motion(const ConfigurationSpace& space, const Configuration& pose,
                             const PlatformVector& velocity, const PlatformVector& acceleration) noexcept {
  return {.axes = axes_of(space, pose),
          .acceleration = translation(space, acceleration),
          .angular_velocity = rotation(space, velocity),
          .angular_acceleration = rotation(space, acceleration)};
}

}  // namespace flinch
