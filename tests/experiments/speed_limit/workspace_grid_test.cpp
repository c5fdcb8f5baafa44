#include "experiments/speed_limit/workspace_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "systems/config/robot_file.h"
#include "systems/robot/parallel_robot.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

RobotFile shipped_robot(const std::string& name) {
  return read_robot_file(test::shipped("robots/" + name + ".yaml"));
}

bool is_allowed(const RobotFile& file, const Eigen::Vector2d& place) {
  Configuration pose = file.robot->home_pose();
  pose.head<2>() = place;
  Kinematics there;
  file.robot->kinematics(pose, PlatformVector::Zero(file.robot->dof()), there);
  return is_within(file.limits, *file.robot, there);
}

TEST(WorkspaceGrid, HasThePlacesOfASquareGridThatAreWithinTheLimits) {
  for (const char* const name : {"planar_3rrr", "five_bar", "hexapod_6ups", "delta"}) {
    const RobotFile file = shipped_robot(name);
    for (const int count : {1, 4, 9}) {
      const auto places = workspace_grid(*file.robot, file.limits, file.robot->home_pose(), count);
      ASSERT_FALSE(places.empty()) << name;
      EXPECT_LE(places.size(), static_cast<std::size_t>(count * count));
      for (const Eigen::Vector2d& place : places) {
        EXPECT_TRUE(is_allowed(file, place)) << name << " " << place.transpose();
        EXPECT_NEAR(1e3 * place.x(), std::round(1e3 * place.x()), 1e-9);
      }
    }
  }
}

/// The rig keeps within 0.35 m of the middle, and its other limits take off no whole side of that.
TEST(WorkspaceGrid, FillsTheWorkspaceOfTheRig) {
  const RobotFile rig = shipped_robot("planar_3rrr");
  const auto places = workspace_grid(*rig.robot, rig.limits, rig.robot->home_pose(), 21);
  double area = 0.0, furthest = 0.0, spacing = 0.0;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    if (places[i].y() == places[i + 1].y()) spacing = places[i + 1].x() - places[i].x();
    furthest = std::max(furthest, places[i].norm());
  }
  area = spacing * spacing * static_cast<double>(places.size());
  EXPECT_LE(furthest, 0.35);
  EXPECT_GT(furthest, 0.3);
  // By random places, without a grid.
  std::size_t inside = 0;
  constexpr int tried = 20'000;
  std::uint64_t seed = 1;
  const auto next = [&seed] {
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(seed >> 11U) * 0x1p-53 - 0.5;
  };
  for (int i = 0; i < tried; ++i) inside += is_allowed(rig, {0.8 * next(), 0.8 * next()}) ? 1 : 0;
  const double expected = 0.64 * static_cast<double>(inside) / tried;
  EXPECT_NEAR(area, expected, 0.06 * expected);
}

TEST(WorkspaceGrid, RefusesAPoseOutsideOfTheLimits) {
  const RobotFile rig = shipped_robot("planar_3rrr");
  Configuration pose = rig.robot->home_pose();
  pose[0] = 0.5;
  const auto problems = test::problems_of([&] { workspace_grid(*rig.robot, rig.limits, pose, 5); });
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_NE(problems.front().find("--at"), std::string::npos);
}

}  // namespace
}  // namespace flinch
