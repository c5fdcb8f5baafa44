#include "drivers/wire_conversion.h"

#include <drivers/idl/flinch.h>
#include <gtest/gtest.h>

#include "drivers/wire_header.h"
#include "systems/framework/random.h"

namespace flinch {
namespace {

JointVector random_vector(RandomGenerator& random, int size) {
  JointVector vector(size);
  for (double& entry : vector) entry = random.normal();
  return vector;
}

TEST(WireConversion, BringsReadingsOfAnyRobotBackBitForBit) {
  RandomGenerator random(1);
  for (int legs = 1; legs <= max_dof; ++legs) {
    const JointReading joints{.acquired = 17ns,
                              .valid = true,
                              .passive_valid = legs % 2 == 0,
                              .active = random_vector(random, legs),
                              .passive = random_vector(random, legs)};
    flinch_JointSample joint_sample;
    JointReading joints_back;
    to_wire(joints, joint_sample);
    from_wire(joint_sample, joints_back);
    EXPECT_EQ(joints_back.acquired, joints.acquired);
    EXPECT_TRUE(joints_back.valid);
    EXPECT_EQ(joints_back.passive_valid, joints.passive_valid);
    EXPECT_EQ(joints_back.active, joints.active);
    EXPECT_EQ(joints_back.passive, joints.passive);

    const TorqueCommand command{.computed = 3ms, .valid = true, .torque = random_vector(random, legs)};
    flinch_TorqueSample torque_sample;
    TorqueCommand command_back;
    BrakeCommand brake_back;
    to_wire(command, {.engage = false}, torque_sample);
    from_wire(torque_sample, command_back);
    from_wire(torque_sample, brake_back);
    EXPECT_EQ(command_back.torque, command.torque);
    EXPECT_EQ(command_back.computed, 3ms);
    EXPECT_TRUE(command_back.valid);
    EXPECT_FALSE(brake_back.engage);
  }
}

TEST(WireConversion, BringsAsManyPassiveAnglesBackAsThereAre) {
  RandomGenerator random(2);
  for (int drives = 1; drives <= max_dof; ++drives) {
    for (int passive = 0; passive <= max_dof; ++passive) {
      const JointReading joints{.acquired = 17ns,
                                .valid = true,
                                .passive_valid = passive % 2 == 1,
                                .active = random_vector(random, drives),
                                .passive = random_vector(random, passive)};
      flinch_JointSample sample;
      JointReading back;
      to_wire(joints, sample);
      from_wire(sample, back);
      EXPECT_EQ(back.passive_valid, joints.passive_valid);
      EXPECT_EQ(back.active, joints.active);
      ASSERT_EQ(back.passive.size(), passive);
      EXPECT_EQ(back.passive, joints.passive);
      sample.header.flags |= 7 << passive_count_bit;
      from_wire(sample, back);
      EXPECT_EQ(back.passive.size(), 0) << "seven are too many";
    }
  }
}

TEST(WireConversion, BringsTheOtherReadingsBack) {
  const ImuReading imu{.acquired = 1ms,
                       .valid = true,
                       .angular_velocity = {1.0, 2.0, 3.0},
                       .specific_force = {4.0, 5.0, 9.81}};
  flinch_ImuSample sample;
  ImuReading back;
  to_wire(imu, sample);
  from_wire(sample, back);
  EXPECT_EQ(back.angular_velocity, imu.angular_velocity);
  EXPECT_EQ(back.specific_force, imu.specific_force);
  EXPECT_TRUE(back.valid);

  for (int bits = 0; bits < 16; ++bits) {
    const StationStatus status{.acquired = 2ms,
                               .valid = (bits & 1) != 0,
                               .enabled = (bits & 2) != 0,
                               .braked = (bits & 4) != 0,
                               .fault = (bits & 8) != 0};
    flinch_StatusSample status_sample;
    StationStatus status_back;
    to_wire(status, status_sample);
    from_wire(status_sample, status_back);
    EXPECT_EQ(status_back.valid, status.valid);
    EXPECT_EQ(status_back.enabled, status.enabled);
    EXPECT_EQ(status_back.braked, status.braked);
    EXPECT_EQ(status_back.fault, status.fault);
  }
}

TEST(WireConversion, MakesWhatIsNotThereInvalidAndNeverAValidZero) {
  flinch_JointSample joints;
  JointReading joints_back;
  to_wire(JointReading(), joints);
  from_wire(joints, joints_back);
  EXPECT_FALSE(joints_back.valid);
  EXPECT_EQ(joints_back.active.size(), 0);

  flinch_TorqueSample torque;
  TorqueCommand command;
  BrakeCommand brake{.engage = false};
  to_wire(TorqueCommand(), BrakeCommand(), torque);
  from_wire(torque, command);
  from_wire(torque, brake);
  EXPECT_FALSE(command.valid);
  EXPECT_TRUE(brake.engage);
}

TEST(WireConversion, DistrustsASampleThatClaimsToBeValidWithAnImpossibleCount) {
  for (const int count : {0, 7, 255}) {
    flinch_DriveSample sample{};
    sample.header.flags = flag_valid;
    sample.header.count = static_cast<std::uint8_t>(count);
    DriveReading reading;
    from_wire(sample, reading);
    EXPECT_FALSE(reading.valid);
    EXPECT_EQ(reading.current.size(), 0);
  }
}

}  // namespace
}  // namespace flinch
