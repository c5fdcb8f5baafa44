#include "systems/robot/imu_mount.h"

#include <Eigen/Geometry>

namespace flinch {

Eigen::Matrix3d platform_to_sensor(const ImuMount& mount) noexcept {
  const Eigen::Matrix3d R_ES = (Eigen::AngleAxisd(mount.angles.x(), Eigen::Vector3d::UnitX()) *
                                Eigen::AngleAxisd(mount.angles.y(), Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(mount.angles.z(), Eigen::Vector3d::UnitZ()))
                                   .toRotationMatrix();
  return R_ES.transpose();
}

Eigen::Vector3d specific_force(const SpatialMotion& now, const Eigen::Vector3d& point,
                               const Eigen::Vector3d& gravity) noexcept {
  const Eigen::Vector3d omega = now.axes.transpose() * now.angular_velocity;
  const Eigen::Vector3d omega_rate = now.axes.transpose() * now.angular_acceleration;
  return now.axes.transpose() * (now.acceleration - gravity) + omega_rate.cross(point) +
         omega.cross(omega.cross(point));
}

}  // namespace flinch
