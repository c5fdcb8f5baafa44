#include "systems/robot/imu_output.h"

#include <Eigen/Geometry>

namespace flinch {
namespace {

/// Along which a coordinate moves the platform, or about which it turns it.
Eigen::Vector3d axis(ConfigurationSpace space, int coordinate) {
  const int rotation = coordinate - space.translations();
  if (rotation < 0) return Eigen::Vector3d::Unit(coordinate);
  return space.rotations() == 1 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::Unit(rotation);
}

}  // namespace

// R turns from platform to base axes. A small rotation by xi in the base frame changes what the platform sees
// of a vector w, R^T w, by R^T (w x xi).
ImuOutput imu_output(ConfigurationSpace space, const MountedImu& imu, const Eigen::Vector3d& gravity,
                     const Configuration& pose, const PlatformVector& velocity,
                     const PlatformVector& acceleration) noexcept {
  const SpatialMotion now = spatial_motion(space, pose, velocity, acceleration);
  const Eigen::Matrix3d R_t = now.axes.transpose();
  const Eigen::Matrix3d& R_SE = imu.to_sensor;
  const Eigen::Matrix3d R_S = R_SE * R_t;  // from base to sensor axes
  const Eigen::Vector3d& p = imu.position_in_platform;
  const Eigen::Vector3d omega = R_t * now.angular_velocity;
  const Eigen::Vector3d force = now.acceleration - gravity;
  const auto centripetal = [&](const Eigen::Vector3d& change) -> Eigen::Vector3d {
    return change.cross(omega.cross(p)) + omega.cross(change.cross(p));
  };

  ImuOutput output;
  output.value << R_SE * omega, R_SE * specific_force(now, p, gravity);
  for (ImuOutput::Jacobian* jacobian : {&output.by_pose, &output.by_velocity, &output.by_acceleration}) {
    jacobian->setZero(6, space.dimension());
  }
  for (int j = 0; j < space.dimension(); ++j) {
    const Eigen::Vector3d unit = axis(space, j);
    if (j < space.translations()) {
      output.by_acceleration.col(j).tail<3>() = R_S.col(j);
      continue;
    }
    const Eigen::Vector3d turned_rate = R_t * now.angular_velocity.cross(unit);
    const Eigen::Vector3d turned_acceleration = R_t * now.angular_acceleration.cross(unit);
    output.by_pose.col(j) << R_SE * turned_rate,
        R_SE * (R_t * force.cross(unit) + turned_acceleration.cross(p) + centripetal(turned_rate));
    output.by_velocity.col(j) << R_S * unit, R_SE * centripetal(R_t * unit);
    output.by_acceleration.col(j).tail<3>() = R_SE * (R_t * unit).cross(p);
  }
  return output;
}

}  // namespace flinch
