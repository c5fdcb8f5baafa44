#include "systems/motion/chart_motion.h"

#include "systems/robot/rotation.h"

namespace flinch {

PlatformReference chart_motion(const ConfigurationSpace& space, const Configuration& base,
                               const PlatformVector& xi, const PlatformVector& xi_rate,
                               const PlatformVector& xi_acceleration) noexcept {
  PlatformReference motion{true, false, space.plus(base, xi), xi_rate, xi_acceleration};
  if (space.rotations() < 3) return motion;
  const Eigen::Vector3d turned = xi.tail<3>();
  const Eigen::Vector3d rate = xi_rate.tail<3>();
  const Eigen::Matrix3d J_l = left_jacobian(turned);
  motion.velocity.tail<3>() = J_l * rate;
  motion.acceleration.tail<3>() = J_l * xi_acceleration.tail<3>() + left_jacobian_rate_times(turned, rate);
  return motion;
}

}  // namespace flinch
