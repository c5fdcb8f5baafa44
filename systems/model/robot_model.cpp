#include "systems/model/robot_model.h"

#include "systems/robot/link_segments.h"

namespace flinch {

WorkspaceMeasures workspace_measures(const Mechanism& robot, const Kinematics& now) {
  if (!now.reachable) return {};
  return {.valid = true,
          .sigma_kappa = now.sigma_kappa,
          .sigma_sc = self_collision_distance(robot, now),
          .platform_gap = robot.platform_gap(now),
          .det_A = now.det_A,
          .det_B = now.det_B,
          .largest_passive_angle = now.joints.passive.lpNorm<Eigen::Infinity>()};
}

void MotionModel::kinematics_of(const PlatformMotion& motion, Kinematics& result) const {
  if (motion.valid()) {
    robot_->kinematics(motion.pose, motion.velocity, result);
  } else if (result.reachable || result.velocity.size() != robot_->dof()) {  // otherwise it is so already
    robot_->kinematics(Configuration(), PlatformVector(), result);           // which no robot can serve
  }
}

void MotionModel::dynamics_of(const Kinematics& now, Dynamics& result) const {
  robot_->dynamics(now, result);
}

WorkspaceMeasures RobotModel::measures_of(const Kinematics& now) const {
  return workspace_measures(robot(), now);
}

}  // namespace flinch
