#include "diagrams/robot_settings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "diagrams/contact_control.h"
#include "systems/config/robot_file.h"
#include "systems/robot/robot_deviation.h"

namespace flinch {
namespace {

RobotFile shipped(const std::string& name) {
  return read_robot_file(FLINCH_SOURCE_DIR "/apps/robots/" + name + ".yaml");
}

ContactControlSettings settings_of(const RobotFile& file) {
  return settings_for(*file.robot, file.drives, file.limits);
}

class ShippedRobot : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(RobotSettings, ShippedRobot,
                         testing::Values("planar_3rrr", "planar_3rrr_nominal", "five_bar", "hexapod_6ups"));

TEST_P(ShippedRobot, HasAControlPathOfItsOwn) {
  const RobotFile file = shipped(GetParam());
  DiagramBuilder builder;
  EXPECT_NO_THROW(add_contact_control(builder, file.robot, settings_of(file)));
}

TEST_P(ShippedRobot, IsBoundedByItsFile) {
  const RobotFile file = shipped(GetParam());
  const ContactControlSettings settings = settings_of(file);
  EXPECT_EQ(settings.drive_torque.torque_constant, file.drives.torque_constant);
  EXPECT_EQ(settings.faults.workspace.max_distance, file.limits.max_distance);
  EXPECT_EQ(settings.faults.max_joint_speed, file.drives.max_speed);
  EXPECT_EQ(settings.faults.max_encoder_rate, file.drives.max_encoder_rate);
  EXPECT_EQ(settings.faults.max_control_error, file.drives.max_control_error);
  EXPECT_EQ(settings.faults.torque_range, file.drives.max_torque);
  EXPECT_EQ(settings.torque_gate.max_torque, file.drives.max_torque);
  EXPECT_EQ(settings.torque_gate.max_torque_rate, file.drives.max_torque_rate);
  EXPECT_EQ(settings.tasks.levels.largest_torque, file.drives.max_torque);
  EXPECT_EQ(settings.tasks.levels.largest_torque_rate, file.drives.max_torque_rate);
}

TEST(RobotSettings, AreForTheBenchThoseOfTheTables) {
  const ContactControlSettings rig = settings_of(shipped("planar_3rrr")), standard;
  EXPECT_NEAR(rig.controlled_stop.damping, standard.controlled_stop.damping, 0.5);
  EXPECT_NEAR(rig.faults.max_unseen_current, standard.faults.max_unseen_current, 0.01);
  EXPECT_EQ(rig.sequence.rest_speed, standard.sequence.rest_speed);
  EXPECT_EQ(rig.faults.max_joint_speed, standard.faults.max_joint_speed);
  EXPECT_EQ(rig.torque_gate.max_torque, standard.torque_gate.max_torque);
  EXPECT_NEAR(rig.tasks.levels.velocity_gain, standard.tasks.levels.velocity_gain, 0.01);
  EXPECT_NEAR(rig.tasks.levels.velocity_feedforward, standard.tasks.levels.velocity_feedforward, 1e-3);
}

TEST(RobotSettings, AreAsStiffAsPublishedWhereThePlatformCanFollow) {
  for (const char* const name :
       {"planar_3rrr", "five_bar", "hexapod_6ups", "delta", "linapod_6pus", "tricept"}) {
    const RobotFile file = shipped(name);
    EXPECT_EQ(settings_of(file).impedance.stiffness, complete({}, file.robot->space()).stiffness) << name;
  }
}

/// The mass matrix of the platform at home is `share` of that of the rig.
void expect_natural_frequency(double share, double frequency) {
  RobotFile file = shipped("planar_3rrr");
  const JointVector legs = JointVector::Constant(3, share);
  const auto other = std::dynamic_pointer_cast<const ParallelRobot>(
      file.robot->deviating({.leg_inertia_scale = legs, .platform_inertia_scale = share}));
  ASSERT_NE(other, nullptr);
  Kinematics k;
  Dynamics dynamics;
  other->kinematics(other->home_pose(), PlatformVector::Zero(3), k);
  other->dynamics(k, dynamics);
  const PlatformVector K = settings_for(*other, file.drives, file.limits).impedance.stiffness;
  for (Eigen::Index i = 0; i < 3; ++i)
    EXPECT_NEAR(std::sqrt(K[i] / dynamics.M_x(i, i)), frequency, 1e-9 * frequency) << i;
}

TEST(RobotSettings, AreSofterForAPlatformOfGramsAndStifferForOneOfTons) {
  expect_natural_frequency(1e-3, 80.0);
  expect_natural_frequency(1e3, 10.0);
}

/// Behind a filter of 30 Hz, which lags by 5.3 ms, a rate that is damped faster would oscillate.
TEST(RobotSettings, StopADriveNoFasterThanTheFilterOfItsRateAllows) {
  const ContactControlSettings light = settings_of(shipped("five_bar")),
                               heavy = settings_of(shipped("hexapod_6ups"));
  EXPECT_LT(light.controlled_stop.damping, 2.0);    // [Nms/rad]: 20 would be 2 ms
  EXPECT_GT(heavy.controlled_stop.damping, 100.0);  // [Ns/m]
}

}  // namespace
}  // namespace flinch
