// How near a hexapod's legs come to its platform, against distances of its outlines by Bullet.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <limits>
#include <vector>

#include "plant/general_rig.h"
#include "systems/config/robot_file.h"
#include "systems/framework/random.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/workspace_limits.h"

namespace flinch {
namespace {

Placement placement(const ParallelRobot& robot, const Kinematics& at, int body) {
  const BodyId of = BodyId::from_index(body);
  const auto point = [&](const Eigen::Vector3d& in_body) -> Eigen::Vector3d {
    return robot.point_on_body(at, of, CartesianVector(in_body));
  };
  Placement placed;
  placed.origin = point(Eigen::Vector3d::Zero());
  for (int axis = 0; axis < 3; ++axis)
    placed.axes.col(axis) = point(Eigen::Vector3d::Unit(axis)) - placed.origin;
  return placed;
}

/// Of the outlines, by Bullet; negative where they overlap.
class GapOfOutlines {
 public:
  explicit GapOfOutlines(const ParallelRobot& robot)
      : robot_(robot), platform_(robot.body(BodyId::platform()).shapes.front()) {
    for (const BesidePlatform& link : robot.description().beside_platform) links_.emplace_back(link.shape);
  }

  double operator()(const Kinematics& at) const {
    double least = std::numeric_limits<double>::infinity();
    const Placement platform = placement(robot_, at, BodyId::platform().index());
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const int body = robot_.description().beside_platform[i].body;
      least = std::min(least, nearest(platform_, platform, links_[i], placement(robot_, at, body)).gap);
    }
    return least;
  }

 private:
  const ParallelRobot& robot_;
  Solid platform_;
  std::vector<Solid> links_;
};

/// A pose in reach somewhere about home, and its kinematics.
class RandomPoses {
 public:
  explicit RandomPoses(const ParallelRobot& robot) : robot_(robot) {}

  Kinematics next() {
    Kinematics at;
    do {
      PlatformVector step(6);
      for (int i = 0; i < 6; ++i) step[i] = (i < 3 ? 0.17 : 0.6) * random_.uniform(-1.0, 1.0);
      robot_.kinematics(robot_.space().plus(robot_.home_pose(), step), PlatformVector::Zero(6), at);
    } while (!at.reachable);
    return at;
  }

 private:
  const ParallelRobot& robot_;
  RandomGenerator random_{7};
};

/// Among which some, at least, overlap.
void expect_gap_of_outlines(const Hexapod& robot, int least_overlapping) {
  const GapOfOutlines truth(robot);
  RandomPoses poses(robot);
  int overlapping = 0;
  for (int i = 0; i < 5000; ++i) {
    const Kinematics at = poses.next();
    const double expected = truth(at), found = robot.platform_gap(at);
    overlapping += expected < 0.0 ? 1 : 0;
    if (expected > 1e-9) {
      EXPECT_NEAR(found, expected, 1e-7);
    }
    if (expected < -1e-9) {
      EXPECT_EQ(found, 0.0) << expected;
    }
  }
  std::cout << overlapping << " of 5000 poses overlap\n";
  EXPECT_GE(overlapping, least_overlapping);
  EXPECT_LT(overlapping, 4900);
}

TEST(PlatformGap, IsTheLeastDistanceOfTheOutlines) { expect_gap_of_outlines(Hexapod(hexapod_robot()), 100); }

TEST(PlatformGap, IsSoWhereTheJointsHangBelowThePlatform) {
  HexapodParameters hanging = hexapod_robot();
  hanging.platform_bottom = 0.03;
  hanging.platform_top = 0.09;
  expect_gap_of_outlines(Hexapod(hanging), 1);
}

/// Otherwise nothing but the sensors' errors would be between platform and legs.
TEST(WorkspaceOfTheHexapod, KeepsLegsFromThePlatform) {
  const RobotFile file = read_robot_file(FLINCH_SOURCE_DIR "/apps/robots/hexapod_6ups.yaml");
  const GapOfOutlines truth(*file.robot);
  RandomPoses poses(*file.robot);
  WorkspaceLimits without = file.limits;
  without.min_platform_gap = 0.0;
  int inside = 0, kept_out = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Kinematics at = poses.next();
    if (!is_within(without, *file.robot, at)) continue;
    const bool is_inside = is_within(file.limits, *file.robot, at);
    ++(is_inside ? inside : kept_out);
    EXPECT_EQ(is_inside, truth(at) >= file.limits.min_platform_gap) << truth(at);
  }
  std::cout << kept_out << " of " << inside + kept_out << " poses are kept out\n";
  EXPECT_GT(inside, 1000);
  EXPECT_GT(kept_out, 0);
}

TEST(GeneralRig, LetsALegTouchThePlatform) {
  const auto robot = std::make_shared<const Hexapod>(hexapod_robot());
  const GapOfOutlines truth(*robot);
  RigSettings settings;
  settings.robot = robot;
  settings.link_material = ContactMaterial();
  const GeneralRig rig(settings);
  RandomPoses poses(*robot);
  int touching = 0;
  for (int i = 0; i < 2000; ++i) {
    const Kinematics at = poses.next();
    GeneralRig::Instant now;
    RigState state = RigState::Zero(12);
    RigChart chart{.pose = at.pose, .xi = PlatformVector::Zero(6)};
    ASSERT_TRUE(rig.at(state, chart, now));
    const ContactSearch search = rig.find_candidates(now, {}, 1e-3);
    double least = std::numeric_limits<double>::infinity();
    rig.for_each_gap(
        now, {}, search.candidates, [](int, int, const SurfaceGap&) {},
        [&](int body, int, const SurfaceGap& gap) {
          if (body == BodyId::platform().index()) least = std::min(least, gap.gap);
        });
    const double expected = truth(at);
    if (std::abs(expected) < 1e-6) continue;
    EXPECT_EQ(least < 0.0, expected < 0.0) << expected;
    if (expected < 0.0) {
      EXPECT_NEAR(least, expected, 1e-9);
    }
    touching += expected < 0.0 ? 1 : 0;
  }
  EXPECT_GT(touching, 50);
}

}  // namespace
}  // namespace flinch
