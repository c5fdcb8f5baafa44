#pragma once

#include <memory>

#include "systems/model/robot_model.h"
#include "systems/robot/link_segments.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/signals/joint_motion.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/platform_motion.h"

/// The planar bench at a pose and velocity, as each block sees it.
namespace flinch::test {

inline std::shared_ptr<const PlanarRrr> planar_bench(BenchFriction friction = BenchFriction::none) {
  return std::make_shared<PlanarRrr>(bench_robot(BenchGeometry::nominal, friction));
}

struct Posture {
  JointReading joints;
  JointMotion motion;
  PlatformMotion platform;
  Kinematics kinematics;
  Dynamics dynamics;
  WorkspaceMeasures measures;

  explicit Posture(const ParallelRobot& robot, const Configuration& pose = Configuration::Zero(3),
                   const PlatformVector& velocity = PlatformVector::Zero(3), Time acquired = {}) {
    robot.kinematics(pose, velocity, kinematics);
    robot.dynamics(kinematics, dynamics);
    joints = {acquired, true, true, kinematics.joints.active, kinematics.joints.passive};
    motion = {acquired, true, kinematics.joints.active, kinematics.rates.active};
    platform = {acquired, PlatformMotion::Status::valid, pose, velocity};
    measures = {.valid = true,
                .sigma_kappa = kinematics.sigma_kappa,
                .sigma_sc = self_collision_distance(robot, kinematics),
                .det_A = kinematics.det_A,
                .det_B = kinematics.det_B,
                .largest_passive_angle = kinematics.joints.passive.lpNorm<Eigen::Infinity>()};
  }
};

}  // namespace flinch::test
