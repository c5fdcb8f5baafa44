#include "identification/excitation.h"

#include <gtest/gtest.h>

#include "systems/config/robot_file.h"
#include "systems/motion/platform_path.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

ExcitationSettings settings_for(const RobotFile& file) {
  ExcitationSettings settings;
  settings.path.duration = 6.0;
  settings.path.distance = 0.1;
  settings.path.workspace = file.limits;
  settings.path.max_drive_speed = file.drives.max_speed;
  settings.max_torque = file.drives.max_torque;
  settings.trials = 60;
  return settings;
}

TEST(Excitation, LowersTheConditionWithinAllLimits) {
  for (const char* const name : {"robots/planar_3rrr.yaml", "robots/hexapod_6ups.yaml"}) {
    const RobotFile file = read_robot_file(test::shipped(name));
    const ExcitationSettings settings = settings_for(file);
    const Excitation got = design_excitation(*file.robot, settings, 1);
    EXPECT_LT(got.condition, 0.9 * got.first_condition) << name;
    EXPECT_LE(got.peak_torque, 0.8 * file.drives.max_torque);
    EXPECT_GE(got.duration, 4.0);
    const PlatformPath path = PlatformPath::through(*file.robot, got.poses, settings.path.limits);
    EXPECT_TRUE(stays_within(*file.robot, path, settings.path)) << name;
    EXPECT_NEAR(path.duration(), got.duration, 1e-9);
  }
}

TEST(Excitation, IsTheSameForTheSameSeed) {
  const RobotFile file = read_robot_file(test::shipped("robots/planar_3rrr.yaml"));
  const ExcitationSettings settings = settings_for(file);
  EXPECT_EQ(design_excitation(*file.robot, settings, 3).condition,
            design_excitation(*file.robot, settings, 3).condition);
}

}  // namespace
}  // namespace flinch
