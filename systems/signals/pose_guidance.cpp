#include "systems/signals/pose_guidance.h"

#include <Eigen/Geometry>

#include "systems/robot/rotation.h"

namespace flinch {

PoseGuidance guide(const ConfigurationSpace& space, const PlatformReference& desired,
                   const Configuration& pose, const PlatformVector& velocity) noexcept {
  PoseGuidance guidance{space.difference(desired.pose, pose), desired.velocity, desired.acceleration};
  if (space.rotations() < 3) return guidance;
  const Eigen::Vector3d e_r = guidance.error.tail<3>();
  const Eigen::Vector3d omega = velocity.tail<3>();
  const Eigen::Matrix3d R_e = rotation_matrix(quaternion_exp(-e_r));  // R R_d^T
  const Eigen::Vector3d omega_r = R_e * desired.velocity.tail<3>();
  guidance.velocity.tail<3>() = omega_r;
  guidance.acceleration.tail<3>() = R_e * desired.acceleration.tail<3>() + omega.cross(omega_r);
  return guidance;
}

PlatformVector spring_wrench(const ConfigurationSpace& space, const PlatformVector& error,
                             const PlatformVector& K_e) noexcept {
  PlatformVector wrench = K_e;
  if (space.rotations() == 3) {
    wrench.tail<3>() = inverse_left_jacobian(error.tail<3>()) * K_e.tail<3>();
  }
  return wrench;
}

}  // namespace flinch
