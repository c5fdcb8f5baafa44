// Boxes that stand askew, and the hulls of their corners.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>
#include <random>

#include "plant/rig_settings.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/rotation.h"
#include "tests/plant/moving_rig.h"
#include "tests/plant/rig_scene.h"

namespace flinch {
namespace {

Box turned_box(const Eigen::Vector3d& half_lengths, const Eigen::Vector3d& rotation) {
  return {.axes = rotation_matrix(quaternion_exp(rotation)), .half_lengths = half_lengths};
}

ConvexHull corners(const Box& box) {
  ConvexHull hull;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d signs((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0,
                                (i & 4) != 0 ? 1.0 : -1.0);
    hull.points.emplace_back(box.axes * signs.cwiseProduct(box.half_lengths));
  }
  return hull;
}

/// What `shape` at `position` does to the resting platform of the planar robot.
Touch touch_of_platform(const std::shared_ptr<const PlanarRrr>& robot, const Shape& shape,
                        const Eigen::Vector3d& position, const ContactMaterial& material) {
  RigSettings settings;
  settings.robot = robot;
  settings.obstacles = {std::make_shared<const FixedObstacle>(
      ObstacleForm{.name = "edge", .shape = shape, .position_in_base = position, .material = material})};
  const test::MovingRig moving(settings);
  for (int i = 0; i < moving.now.contacts.touch_count; ++i) {
    const Touch& touch = moving.now.contacts.touches[static_cast<std::size_t>(i)];
    if (touch.body == 0) return touch;
  }
  return {};
}

// The platform is round: its face or edge that is nearest to the origin is as deep in it as it is nearer than
// the radius, and pushes along the line to there.
TEST(ATurnedBox, PushesThePlatformByTheFaceOrEdgeThatIsNearest) {
  const auto robot = test::individual_rig();
  const double radius = robot->parameters().platform_hull_radius;
  const Eigen::Vector2d home = robot->home_pose().head<2>();
  const ContactMaterial elastic{.stiffness = 2e4, .restitution = 1.0};
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double worst = 0.0, worst_hull = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double turn = 6.0 * unit(generator), depth = 1e-3 + 0.02 * unit(generator);
    const Eigen::Vector3d half(0.03 + 0.02 * unit(generator), 0.03, 0.05);
    const Box box = turned_box(half, {0.0, 0.0, turn});
    const bool by_edge = i % 2 == 0;
    // From the platform to the box: against its face of -x, or against the edge of -x and -y.
    const double aside = by_edge ? std::numbers::pi / 4.0 * (0.4 + 1.2 * unit(generator)) : 0.0;
    const Eigen::Vector2d out(std::cos(turn + aside), std::sin(turn + aside));
    const Eigen::Vector2d to_centre =
        box.axes.topLeftCorner<2, 2>() * Eigen::Vector2d(half.x(), by_edge ? half.y() : 0.0);
    Eigen::Vector3d position(0.0, 0.0, 0.0);
    position.head<2>() = home + (radius - depth) * out + to_centre;

    const Touch touch = touch_of_platform(robot, box, position, elastic);
    const Touch of_hull = touch_of_platform(robot, corners(box), position, elastic);
    ASSERT_EQ(touch.obstacle, 0);
    EXPECT_NEAR(touch.depth, depth, 1e-11);
    EXPECT_NEAR(of_hull.depth, depth, 1e-11);
    worst = std::max(worst, (touch.force_on_robot.head<2>() + elastic.stiffness * depth * out).norm());
    worst_hull = std::max(worst_hull, (of_hull.force_on_robot - touch.force_on_robot).norm());
  }
  std::cout << "force of a turned box: " << worst << " N off, that of its hull " << worst_hull << " N more\n";
  EXPECT_LT(worst, 1e-6);
  EXPECT_LT(worst_hull, 1e-6);
}

// The hexapod runs into a box that is turned about no axis of the base, or into the hull of its corners.
TEST(HexapodAgainstATurnedBox, MovesAsAgainstTheHullOfItsCorners) {
  const Box box = turned_box({0.05, 0.08, 0.06}, {0.4, -0.7, 0.5});
  const ContactMaterial elastic{.stiffness = 2e4, .restitution = 1.0, .friction = 0.0};
  const auto moving_against = [&](const Shape& shape) {
    RigSettings settings;
    settings.robot = std::make_shared<const Hexapod>(hexapod_robot());
    settings.initial_velocity = PlatformVector{{0.6, 0.1, 0.0, 0.2, 0.3, 0.4}};
    settings.link_material.reset();
    settings.obstacles = {std::make_shared<const FixedObstacle>(ObstacleForm{
        .name = "box", .shape = shape, .position_in_base = {0.40, 0.02, 0.62}, .material = elastic})};
    return test::MovingRig(settings, {.relative_tolerance = 1e-10, .absolute_tolerance = 1e-11});
  };
  test::MovingRig against_box = moving_against(box), against_hull = moving_against(corners(box));
  ASSERT_EQ(against_box.now.contacts.touch_count, 0);
  const double start = against_hull.now.kinetic_energy;
  double apart = 0.0, imbalance = 0.0, strongest = 0.0;
  for (int k = 0; k < 120; ++k) {
    for (test::MovingRig* moving : {&against_box, &against_hull}) {
      moving->equation.drives.torque << 30.0, 35.0, 30.0, 35.0, 30.0, 40.0;
      moving->tick();
      ASSERT_TRUE(moving->now.reachable);
    }
    const Mechanism& robot = against_box.rig->robot();
    apart = std::max(apart, robot.difference(against_box.now.pose, against_hull.now.pose).norm());
    imbalance = std::max(imbalance, std::abs(against_hull.now.kinetic_energy - start - against_hull.work()));
    if (against_hull.now.contacts.touch_count > 0)
      strongest = std::max(strongest, against_hull.now.contacts.touches[0].force_on_robot.norm());
  }
  std::cout << "box and hull: " << apart << " m, rad apart; imbalance " << imbalance << " J, at most "
            << strongest << " N\n";
  EXPECT_LT(apart, 1e-8);
  EXPECT_LT(imbalance, 1e-6);
  EXPECT_GT(strongest, 100.0);
}

}  // namespace
}  // namespace flinch
