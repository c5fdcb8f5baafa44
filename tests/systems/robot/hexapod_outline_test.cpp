#include "systems/robot/hexapod_outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/framework/random.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"

namespace flinch {
namespace {

const HexapodParameters parameters = hexapod_robot();

/// Corner `i` of the platform as seen along its axis.
Eigen::Vector2d corner(int i) {
  const double angle = i * std::numbers::pi / 6.0;
  return parameters.platform_radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

/// By its sides as segments, one after the other; 0 where the point is to the left of all of them.
double distance_from_polygon(const Eigen::Vector2d& point) {
  double least = HUGE_VAL;
  bool is_inside = true;
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector2d from = corner(i), side = corner(i + 1) - from, to_point = point - from;
    is_inside = is_inside && side.x() * to_point.y() - side.y() * to_point.x() >= 0.0;
    const double share = std::clamp(side.dot(to_point) / side.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (to_point - share * side).norm());
  }
  return is_inside ? 0.0 : least;
}

TEST(DistanceFromThePlatform, IsThatFromAPolygonAndTwoPlanes) {
  RandomGenerator random(3);
  for (int i = 0; i < 20'000; ++i) {
    const Eigen::Vector3d point(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5),
                                random.uniform(-0.2, 0.2));
    const double across = distance_from_polygon(point.head<2>());
    const double along = std::max({-0.02 - point.z(), point.z() - 0.04, 0.0});
    EXPECT_NEAR(distance_from_platform(parameters, point), std::hypot(across, along), 1e-12);
  }
}

TEST(DistanceFromThePlatform, IsZeroAtTheJoints) {
  for (const HexapodLeg& leg : parameters.legs)
    EXPECT_EQ(distance_from_platform(parameters, leg.platform_joint), 0.0);
}

TEST(HeldStretches, EndTwiceAsFarAsTheRodsOverlapAtHome) {
  const std::array<double, 6> held = held_stretches(parameters);
  for (std::size_t i = 0; i < 6; ++i) {
    const HexapodLeg& leg = parameters.legs[i];
    const Eigen::Vector3d away =
        (leg.base_joint - parameters.home_position - leg.platform_joint).normalized();
    EXPECT_NEAR(distance_from_platform(parameters, leg.platform_joint + 0.5 * held[i] * away),
                parameters.rod_radius, 1e-9);
    EXPECT_GT(held[i], 2.0 * parameters.rod_radius);
    EXPECT_LT(held[i], 0.2 * parameters.rod_length);
  }
}

TEST(HeldStretches, AreNoneOfJointsOutsideOfThePlatform) {
  HexapodParameters hanging = parameters;
  hanging.platform_bottom = 0.03;
  hanging.platform_top = 0.09;
  for (const double held : held_stretches(hanging)) EXPECT_EQ(held, 0.0);
}

TEST(PlatformGap, IsZeroWithoutKinematicsAndPositiveAtHome) {
  const Hexapod robot(parameters);
  Kinematics kinematics;
  robot.kinematics(robot.home_pose(), PlatformVector::Zero(6), kinematics);
  EXPECT_GT(robot.platform_gap(kinematics), 0.02);
  robot.kinematics(Configuration(), PlatformVector(), kinematics);
  EXPECT_EQ(robot.platform_gap(kinematics), 0.0);
}

}  // namespace
}  // namespace flinch
