#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "systems/robot/contact_jacobian.h"
#include "systems/robot/link_contact.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/wrench_estimate.h"
#include "tests/systems/robot/random_motion.h"

/// The planar rig, touched: what tests of isolation begin with.
namespace flinch::test {

inline std::shared_ptr<const PlanarRrr> touched_rig() {
  return std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::test_rig));
}

inline Kinematics kinematics_of(const ParallelRobot& robot, const Configuration& pose,
                                const PlatformVector& velocity) {
  Kinematics kinematics;
  robot.kinematics(pose, velocity, kinematics);
  return kinematics;
}

inline Kinematics at_home(const ParallelRobot& robot) {
  return kinematics_of(robot, robot.home_pose(), PlatformVector::Zero(robot.dof()));
}

/// `count` states of the rig within its workspace, at rest or moving.
inline std::vector<Kinematics> random_kinematics(const PlanarRrr& robot, int count,
                                                 double share_of_velocity = 1.0, unsigned seed = 1) {
  std::vector<Kinematics> all;
  for (const auto& [pose, velocity] : flinch::test::random_motions(robot, count, seed)) {
    all.push_back(kinematics_of(robot, pose, share_of_velocity * velocity));
  }
  return all;
}

/// What the platform feels of a force on a link at a fraction of its axis, along and across it [N].
inline PlatformVector wrench_on_link(const ParallelRobot& robot, const Kinematics& k, BodyId link,
                                     double fraction, const Eigen::Vector2d& along_and_across) {
  const LegPoints& leg = k.legs[static_cast<std::size_t>(link.leg())];
  const Eigen::Vector2d axis =
      link.is_link1() ? leg.passive_joint - leg.base_joint : leg.coupling_joint - leg.passive_joint;
  const CartesianVector force = rotate(axis.normalized(), along_and_across);
  return platform_wrench(robot.contact_jacobian(k, link, robot.axis_point(link, fraction)), force);
}

inline WrenchEstimate estimate_of(const Kinematics& k, const PlatformVector& wrench, Time acquired = 5ms) {
  return {.acquired = acquired,
          .valid = true,
          .wrench_in_base = wrench,
          .drive_torque = drive_torques(k, wrench)};
}

}  // namespace flinch::test
