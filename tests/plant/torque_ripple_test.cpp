#include "plant/torque_ripple.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "plant/rig_dynamics.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/forward_dynamics.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "tests/plant/rig_scene.h"

namespace flinch {
namespace {

TEST(TorqueRipple, AddsCoggingAndAShareOfTheTorque) {
  const TorqueRipple torque{.cogging = {{.amplitude = 0.5, .rate = 24.0, .phase = 0.3}},
                            .ripple = {.amplitude = 0.01, .rate = 66.0, .phase = -1.0}};
  EXPECT_DOUBLE_EQ(torque.at(0.2, 0.0), 0.5 * std::sin(24.0 * 0.2 + 0.3));
  EXPECT_DOUBLE_EQ(torque.at(0.2, 20.0) - torque.at(0.2, 0.0),
                   20.0 * (1.0 + 0.01 * std::sin(66.0 * 0.2 - 1.0)));
  EXPECT_EQ(TorqueRipple().at(0.2, 20.0), 20.0);
}

/// A state of the rig that moves.
RigState somewhere(const RigDynamics& rig) {
  const int n = rig.robot().dof();
  RigState state = rig.initial_state();
  for (int i = 0; i < n; ++i) {
    state[i] += 0.01 * (i + 1) * (i % 2 == 0 ? 1.0 : -1.0);
    state[n + i] = 0.1 * (i + 1);
  }
  return state;
}

// Every mechanism, the planar one in its closed forms as well: torques follow from the drive positions that
// the robot itself tells, accelerations from these torques.
TEST(TorqueRipple, ActsOnTheDrivesOfEveryMechanism) {
  const std::vector<std::shared_ptr<const Mechanism>> robots = {
      test::individual_rig(RigFriction::test_rig), std::make_shared<const FiveBar>(five_bar_robot()),
      std::make_shared<const Hexapod>(hexapod_robot(HexapodPayload::none, HexapodFriction::ball_screws))};
  for (const auto& robot : robots) {
    RigSettings settings;
    settings.robot = robot;
    const bool turns = robot->drive_kind(0) == DriveKind::revolute;
    for (int i = 0; i < robot->drives(); ++i) {
      settings.torque_ripple.push_back(
          {.cogging = {{.amplitude = 0.4 + 0.1 * i, .rate = turns ? 24.0 : 3e4, .phase = 0.5 * i},
                       {.amplitude = 0.1, .rate = turns ? 48.0 : 6e4, .phase = 0.2}},
           .ripple = {.amplitude = 0.01, .rate = turns ? 66.0 : 8e4, .phase = 1.0}});
    }
    const auto rig = RigDynamics::make(settings);
    DriveAction drives;
    drives.torque = JointVector::LinSpaced(robot->drives(), -3.0, 5.0);
    drives.enabled = true;
    drives.braked = false;
    const PlatformVector wrench = PlatformVector::Zero(robot->dof());
    RigSnapshot now;
    rig->snapshot(somewhere(*rig), drives, wrench, rig->initial_step(), 1e-3, now);

    Kinematics k;
    Dynamics dynamics;
    robot->kinematics(now.pose, now.velocity, k);
    robot->dynamics(k, dynamics);
    JointVector torque = drives.torque;
    for (int i = 0; i < robot->drives(); ++i) {
      torque[i] = settings.torque_ripple[static_cast<std::size_t>(i)].at(k.joints.active[i], torque[i]);
    }
    EXPECT_GT((torque - drives.torque).norm(), 0.1);
    EXPECT_LT((now.drive_torque - torque).norm(), turns ? 1e-12 : 1e-9) << robot->name();
    const auto expected = forward_dynamics(k, dynamics, torque, wrench);
    ASSERT_TRUE(expected.has_value());
    EXPECT_LT((now.acceleration - *expected).norm(), 1e-9 * (1.0 + expected->norm())) << robot->name();
  }
}

TEST(TorqueRipple, IsRefusedForAnotherNumberOfDrives) {
  RigSettings settings;
  settings.robot = test::individual_rig();
  settings.torque_ripple.resize(2);
  EXPECT_THROW(RigDynamics::make(settings), SetupError);
}

}  // namespace
}  // namespace flinch
