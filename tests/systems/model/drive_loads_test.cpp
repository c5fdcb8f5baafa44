#include "systems/model/drive_loads.h"

#include <gtest/gtest.h>

#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

const PlatformVector pose{{0.05, -0.02, 0.1}}, velocity{{0.4, 0.3, -1.0}};

struct Loads {
  explicit Loads(const std::shared_ptr<const Mechanism>& robot)
      : block(builder.add<DriveLoads>("loads", robot)) {}

  DriveLoad of(const test::Posture& at, const DriveTorque& drives) {
    ticking.set(platform, at.platform);
    ticking.set(kinematics, at.kinematics);
    ticking.set(dynamics, at.dynamics);
    ticking.set(torque, drives);
    ticking.tick();
    return ticking.get(block.load);
  }

  DiagramBuilder builder;
  DriveLoads& block;
  InputPort<PlatformMotion> platform = builder.export_input("platform", block.platform);
  InputPort<Kinematics> kinematics = builder.export_input("kinematics", block.kinematics);
  InputPort<Dynamics> dynamics = builder.export_input("dynamics", block.dynamics);
  InputPort<DriveTorque> torque = builder.export_input("torque", block.torque);
  test::Ticking ticking{builder};
};

const JointVector torque{{1.0, -2.0, 3.0}};

TEST(DriveLoads, HaveThePowerOfAllFriction) {
  const auto robot = test::planar_rig(RigFriction::test_rig);
  const test::Posture at(*robot, pose, velocity, 7ms);
  const DriveLoad load = Loads(robot).of(at, {7ms, true, torque});
  ASSERT_TRUE(load.valid);
  EXPECT_EQ(load.acquired, 7ms);
  EXPECT_EQ(load.torque, torque);
  EXPECT_EQ(load.rate, at.kinematics.rates.active);
  double power = 0.0;  // of the joints, one by one
  for (int leg = 0; leg < 3; ++leg) {
    const PlanarRrrLeg& of = robot->parameters().legs[static_cast<std::size_t>(leg)];
    const auto friction = [&](const JointFriction& joint, double rate) {
      return rate * (joint.viscous * rate + joint.coulomb * std::tanh(rate / 0.01));
    };
    power += friction(of.active_friction, at.kinematics.rates.active[leg]) +
             friction(of.passive_friction, at.kinematics.rates.passive[leg]);
  }
  EXPECT_NEAR(load.friction.dot(load.rate), power, 1e-12);
}

TEST(DriveLoads, HaveTheInertiaThatMakesTorquesOfAccelerations) {
  const auto robot = test::planar_rig();
  const test::Posture at(*robot, pose, velocity);
  const auto acceleration = [&](const JointVector& by) {
    return JointVector(robot->drive_acceleration(pose, velocity, by).value());
  };
  Eigen::Matrix3d by_torque;  // of the drives, from the equation of motion
  for (int i = 0; i < 3; ++i)
    by_torque.col(i) = acceleration(torque + Eigen::Vector3d::Unit(i)) - acceleration(torque);
  const Eigen::Vector3d length = by_torque.inverse().rowwise().norm();
  EXPECT_LT((Loads(robot).of(at, {{}, true, torque}).inertia - length).norm(), 1e-9 * length.norm());
}

TEST(DriveLoads, HaveTheTorqueThatTurnsThePlatform) {
  const auto robot = test::planar_rig();
  const test::Posture at(*robot, pose, velocity);
  const auto turned =
      robot->acceleration(pose.head<3>(), velocity.head<3>(), torque.head<3>(), Eigen::Vector3d::Zero());
  const Eigen::Vector3d wrench = at.dynamics.M_x.col(2) * turned.value()[2];  // of that acceleration alone
  const JointVector efforts = Loads(robot).of(at, {{}, true, torque}).turning;
  for (int drive = 0; drive < 3; ++drive) {  // each has the power of the wrench at its rate
    const Eigen::Vector3d moved = at.kinematics.J_x_qa.col(drive);
    EXPECT_NEAR(efforts[drive], wrench.dot(moved), 1e-9) << drive;
  }
}

TEST(DriveLoads, DoNotKnowDryFrictionOfADriveThatStandsStill) {
  const auto robot = test::planar_rig(RigFriction::test_rig);
  const double most = robot->dry_friction(0).effort;
  ASSERT_GT(most, 0.0);
  Loads loads(robot);
  const DriveLoad still = loads.of(test::Posture(*robot, pose, PlatformVector::Zero(3)), {{}, true, torque});
  for (int drive = 0; drive < 3; ++drive) {
    EXPECT_NEAR(still.friction_bounds.low[drive], -1.5 * robot->dry_friction(drive).effort, 1e-12);
    EXPECT_NEAR(still.friction_bounds.high[drive], 1.5 * robot->dry_friction(drive).effort, 1e-12);
  }
}

TEST(DriveLoads, AreNotValidWhereSomethingIsMissing) {
  const auto robot = test::planar_rig();
  const test::Posture at(*robot, pose, velocity);
  Loads loads(robot);
  EXPECT_TRUE(loads.of(at, {{}, true, torque}).valid);
  EXPECT_FALSE(loads.of(at, {{}, false, torque}).valid);
  EXPECT_FALSE(loads.of(at, {{}, true, JointVector::Zero(2)}).valid);
  EXPECT_FALSE(loads.of(at, {{}, true, JointVector::Constant(3, std::nan(""))}).valid);
  test::Posture lost = at;
  lost.platform.status = PlatformMotion::Status::no_data;
  EXPECT_FALSE(loads.of(lost, {{}, true, torque}).valid);
}

}  // namespace
}  // namespace flinch
