#include "experiments/robot_check/robot_workspace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/config/robot_file.h"
#include "systems/framework/random.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

// Both legs of a five-bar reach a point that is neither too far from nor too near to their bases.
TEST(ThePosesInReach, OfAFiveBarAreThoseOfTwoRings) {
  const FiveBar robot(five_bar_robot());
  const WorkspaceLimits none;
  const PoseCheck check(robot, none);
  RandomGenerator random(1);
  int in_reach = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Configuration pose = Eigen::Vector2d(random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6));
    bool expected = true;
    double margin = 1.0;
    for (const FiveBarLeg& leg : robot.parameters().legs) {
      const double distance = (Eigen::Vector2d(pose) - leg.base_joint).norm();
      const double longest = leg.link1_length + leg.link2_length;
      const double shortest = std::abs(leg.link1_length - leg.link2_length);
      expected = expected && distance < longest && distance > shortest;
      margin = std::min({margin, std::abs(distance - longest), std::abs(distance - shortest)});
    }
    if (margin < 1e-6) continue;
    EXPECT_EQ(check.at(pose).reachable, expected) << pose.transpose();
    in_reach += expected ? 1 : 0;
  }
  EXPECT_GT(in_reach, 50);
}

TEST(ThePosesWithinLimits, AreThoseThatTheGateLetsPass) {
  for (const char* const name :
       {"robots/planar_3rrr.yaml", "robots/delta.yaml", "robots/hexapod_6ups.yaml"}) {
    const RobotFile file = read_robot_file(test::shipped(name));
    const int translations = file.robot->space().translations();
    const PoseCheck check(*file.robot, file.limits);
    RandomGenerator random(2);
    int within = 0;
    for (int trial = 0; trial < 300; ++trial) {
      PlatformVector away = PlatformVector::Zero(file.robot->dof());
      for (int axis = 0; axis < translations; ++axis) away[axis] = random.uniform(-0.3, 0.3);
      const Configuration pose = file.robot->space().plus(file.robot->home_pose(), away);
      const WorkspacePose seen = check.at(pose);
      if (seen.beyond_singularity) continue;
      Kinematics at;
      file.robot->kinematics(pose, PlatformVector::Zero(file.robot->dof()), at);
      EXPECT_EQ(seen.is_within(), is_within(file.limits, *file.robot, at)) << name;
      within += seen.is_within() ? 1 : 0;
    }
    EXPECT_GT(within, 10) << name;
  }
}

TEST(TheWorkspace, CountsEachPoseOnce) {
  const RobotFile file = read_robot_file(test::shipped("robots/planar_3rrr.yaml"));
  const RobotWorkspace found = robot_workspace(*file.robot, file.limits);
  ASSERT_EQ(found.reach.size(), 2U);
  EXPECT_LT(found.reach[0][0], -0.1);
  EXPECT_GT(found.reach[0][1], 0.1);
  EXPECT_GT(found.within(), 0U);
  EXPECT_LT(found.within() + found.beyond_singularity, found.poses);
  EXPECT_EQ(found.breaking.size(), limit_names(*file.robot).size());
  EXPECT_TRUE(std::is_sorted(found.sigma_kappa.begin(), found.sigma_kappa.end()));
  EXPECT_LE(found.drives[0], found.drives[1]);
}

// Its det A is what is 0 there.
TEST(TheNearestSingularity, IsWhereTheDeterminantChangesItsSign) {
  const RobotFile file = read_robot_file(test::shipped("robots/planar_3rrr.yaml"));
  const RobotWorkspace found = robot_workspace(*file.robot, file.limits);
  ASSERT_TRUE(found.nearest_singularity.has_value());
  const auto det_A = [&](double way) {
    PlatformVector away = PlatformVector::Zero(3);
    away.head(2) = way * found.nearest_singularity->direction;
    Kinematics at;
    file.robot->kinematics(file.robot->space().plus(file.robot->home_pose(), away), PlatformVector::Zero(3),
                           at);
    return at.det_A;
  };
  const double distance = found.nearest_singularity->distance;
  EXPECT_LE(det_A(distance) * det_A(0.0), 0.0);
  EXPECT_GT(det_A(0.95 * distance) * det_A(0.0), 0.0);
}

}  // namespace
}  // namespace flinch
