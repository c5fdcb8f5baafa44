#include "systems/motion/random_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "systems/config/robot_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/link_segments.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class RandomPath : public ::testing::TestWithParam<const char*> {
 protected:
  const RobotFile file = read_robot_file(std::string(FLINCH_SOURCE_DIR "/apps/robots/") + GetParam());
  const ParallelRobot& robot = *file.robot;

  RandomPathSettings settings() const {
    RandomPathSettings settings;
    settings.distance = 0.1;
    settings.rotation = 0.2;
    settings.limits.translation = {.velocity = 0.5, .acceleration = 5.0, .jerk = 200.0};
    settings.limits.rotation = {.velocity = 2.0, .acceleration = 40.0, .jerk = 4000.0};
    settings.workspace = file.limits;
    settings.max_drive_speed = file.drives.max_speed;
    return settings;
  }
};

TEST_P(RandomPath, KeepsTheLimitsOfTheRobotEverywhere) {
  const PlatformPath path = random_path(robot, settings(), 1);
  EXPECT_GE(path.duration(), 6.0);
  Kinematics k;
  for (double time = 0.0; time < path.duration(); time += 1.7e-3) {
    const PlatformReference at = path.evaluate(time);
    robot.kinematics(at.pose, at.velocity, k);
    ASSERT_TRUE(k.valid);
    EXPECT_GT(std::abs(k.det_A), file.limits.min_abs_det_A);
    EXPECT_GT(self_collision_distance(robot, k), file.limits.min_self_collision_distance);
    EXPECT_LT(distance_from_centre(file.limits, robot, at.pose), file.limits.max_distance);
    EXPECT_GT(k.joints.active.minCoeff(), file.limits.min_active);
    EXPECT_LT(k.joints.active.maxCoeff(), file.limits.max_active);
    EXPECT_LT(k.rates.active.cwiseAbs().maxCoeff(), file.drives.max_speed);
    const PlatformVector away = robot.difference(at.pose, robot.home_pose());
    EXPECT_LE(away.head(robot.space_dimension()).norm(), 0.1 + 1e-9);
  }
}

TEST_P(RandomPath, FollowsFromItsSeed) {
  const PlatformPath once = random_path(robot, settings(), 1), again = random_path(robot, settings(), 1);
  const PlatformPath other = random_path(robot, settings(), 2);
  EXPECT_EQ(once.duration(), again.duration());
  EXPECT_EQ(once.evaluate(3.0).pose, again.evaluate(3.0).pose);
  EXPECT_NE(once.duration(), other.duration());
}

TEST_P(RandomPath, StandsStillAtItsPosesWhereItShall) {
  RandomPathSettings pausing = settings();
  pausing.pause = 4.0;
  const PlatformPath path = random_path(robot, pausing, 1);
  EXPECT_GE(path.duration(), pausing.duration);
  double still = 0.0;  // [s]
  for (double time = 0.0; time < path.duration(); time += 1e-3)
    still += path.evaluate(time).velocity.norm() == 0.0 ? 1e-3 : 0.0;
  EXPECT_GT(still, 3.9);
  pausing.pause = -0.1;
  EXPECT_THROW(random_path(robot, pausing, 1), SetupError);
}

TEST_P(RandomPath, SaysSoWhereNoPoseCanBeReached) {
  RandomPathSettings too_fast = settings();
  too_fast.max_drive_speed = 1e-6;
  EXPECT_THROW(random_path(robot, too_fast, 1), SetupError);
}

TEST_P(RandomPath, LastsAnHour) {
  RandomPathSettings hour = settings();
  hour.duration = 3600.0;
  const PlatformPath path = random_path(robot, hour, 1);
  EXPECT_GE(path.duration(), 3600.0);
  EXPECT_LT(path.duration(), 3610.0);
  EXPECT_GT(path.evaluate(3599.0).pose.norm(), 0.0);
}

// However small or slow the ways are, as many are planned as can be afforded, and it is said which settings
// would do.
TEST_P(RandomPath, EndsWhateverIsAsked) {
  const auto complaint = [this](const RandomPathSettings& asked) {
    const auto problems = test::problems_of([&] { random_path(robot, asked, 1); });
    return problems.empty() ? std::string("none") : problems.front();
  };
  RandomPathSettings tiny = settings();
  tiny.duration = 3600.0;
  tiny.distance = 1e-6;
  tiny.rotation = 0.0;
  EXPECT_THAT(complaint(tiny), AllOf(HasSubstr("50000 random poses within 1e-06 m and 0 rad"),
                                     HasSubstr("of 3600 s"), HasSubstr("raise distance, rotation or pause")));
  RandomPathSettings slow = settings();  // of which none is within the limits
  slow.limits.translation.velocity = slow.limits.rotation.velocity = 1e-4;
  slow.workspace.max_distance = 0.0;
  slow.duration = 3600.0;
  EXPECT_THAT(complaint(slow), AllOf(HasSubstr("of 3600 s; lower distance, rotation or duration")));
}

INSTANTIATE_TEST_SUITE_P(Robots, RandomPath,
                         ::testing::Values("planar_3rrr.yaml", "five_bar.yaml", "hexapod_6ups.yaml"),
                         [](const ::testing::TestParamInfo<const char*>& robot) {
                           const std::string name = robot.param;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace flinch
