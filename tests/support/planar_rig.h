#pragma once

#include <memory>

#include "systems/model/robot_model.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/signals/joint_motion.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/platform_motion.h"

/// The planar rig at a pose and velocity, as each block sees it.
namespace flinch::test {

inline std::shared_ptr<const PlanarRrr> planar_rig(RigFriction friction = RigFriction::none) {
  return std::make_shared<PlanarRrr>(rig_robot(RigGeometry::nominal, friction));
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
    measures = workspace_measures(robot, kinematics);
  }
};

}  // namespace flinch::test
