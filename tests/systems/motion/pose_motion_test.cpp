#include "systems/motion/pose_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "tests/support/allocations.h"

namespace flinch {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const PoseLimits limits{{1.0, 20.0, 2000.0}, {4.0, 80.0, 8000.0}};
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

constexpr ConfigurationSpace plane = ConfigurationSpace::Kind::planar_pose;

/// A start, how it moves there, and the way to the goal.
struct Way {
  ConfigurationSpace space;
  Configuration start;
  PlatformVector velocity;
  PlatformVector displacement;
};

Way random_way(ConfigurationSpace::Kind kind, std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  const ConfigurationSpace space = kind;
  const auto random = [&](double size) {
    return PlatformVector(
        PlatformVector::NullaryExpr(space.dimension(), [&] { return size * normal(generator); }));
  };
  return {space, space.plus(space.origin(), random(0.5)), random(0.5), random(0.5)};
}

class PoseMotionIn : public testing::TestWithParam<ConfigurationSpace::Kind> {};

TEST_P(PoseMotionIn, MovesAsItSays) {
  std::mt19937_64 generator(1);
  constexpr double h = 1e-5;
  for (int i = 0; i < 50; ++i) {
    const Way way = random_way(GetParam(), generator);
    const auto motion = PoseMotion::plan(way.space, way.start, way.velocity, way.displacement, limits);
    ASSERT_TRUE(motion.valid());
    for (int k = 1; k < 40; ++k) {
      const double time = k * motion.duration() / 40;
      const PlatformReference before = motion.evaluate(time - h), now = motion.evaluate(time),
                              after = motion.evaluate(time + h);
      ASSERT_LT((way.space.difference(after.pose, before.pose) / (2 * h) - now.velocity).norm(), 1e-6);
      // A corner of jerk may lie in between.
      ASSERT_LT(((after.velocity - before.velocity) / (2 * h) - now.acceleration).norm(), 8000 * h);
    }
  }
}

TEST_P(PoseMotionIn, BeginsAsItIsAndRestsAtTheGoal) {
  std::mt19937_64 generator(2);
  for (int i = 0; i < 50; ++i) {
    const Way way = random_way(GetParam(), generator);
    const auto motion = PoseMotion::plan(way.space, way.start, way.velocity, way.displacement, limits);
    const PlatformReference begin = motion.evaluate(0.0), end = motion.evaluate(motion.duration());
    EXPECT_LT(way.space.difference(begin.pose, way.start).norm(), 1e-15);
    EXPECT_LT((begin.velocity - way.velocity).norm(), 1e-14);
    EXPECT_LT(begin.acceleration.norm(), 1e-12);
    EXPECT_TRUE(end.finished);
    EXPECT_EQ(end.pose, way.space.plus(way.start, way.displacement));
    EXPECT_EQ(end.pose, motion.goal());
    EXPECT_EQ(end.velocity.norm(), 0.0);
    EXPECT_EQ(end.acceleration.norm(), 0.0);
  }
}

TEST_P(PoseMotionIn, KeepsItsLimitsFromRest) {
  std::mt19937_64 generator(3);
  const double margin = 1 + 1e-9;
  for (int i = 0; i < 50; ++i) {
    Way way = random_way(GetParam(), generator);
    way.velocity.setZero();
    const auto motion = PoseMotion::plan(way.space, way.start, way.velocity, way.displacement, limits);
    for (int k = 0; k <= 100; ++k) {
      const PlatformReference now = motion.evaluate(k * motion.duration() / 100);
      const int translations = way.space.translations(), rotations = way.space.rotations();
      ASSERT_LE(now.velocity.head(translations).norm(), limits.translation.velocity * margin);
      ASSERT_LE(now.velocity.tail(rotations).norm(), limits.rotation.velocity * margin);
      ASSERT_LE(now.acceleration.head(translations).norm(), limits.translation.acceleration * margin);
      ASSERT_LE(now.acceleration.tail(rotations).norm(), limits.rotation.acceleration * margin);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EverySpace, PoseMotionIn,
                         testing::Values(ConfigurationSpace::Kind::plane, ConfigurationSpace::Kind::space,
                                         ConfigurationSpace::Kind::planar_pose,
                                         ConfigurationSpace::Kind::spatial_pose));

TEST(PoseMotion, TurnsAboutAFixedAxisInSpace) {
  const ConfigurationSpace space = ConfigurationSpace::Kind::spatial_pose;
  PlatformVector displacement = PlatformVector::Zero(6);
  displacement.tail<3>() = Vector3d(1.0, 2.0, -2.0) / 3.0;
  const auto motion = PoseMotion::plan(space, space.origin(), PlatformVector::Zero(6), displacement, limits);
  const auto angle = JerkLimitedProfile::plan({}, 1.0, limits.rotation);
  for (int k = 0; k < 100; ++k) {
    const double time = k * motion.duration() / 100;
    const PlatformReference now = motion.evaluate(time);
    const double turned = angle.evaluate(time).position;
    EXPECT_LT((space.difference(now.pose, space.origin()) - turned * displacement).norm(), 1e-14);
    EXPECT_LT((now.velocity - angle.evaluate(time).velocity * displacement).norm(), 1e-13);
  }
}

TEST(PoseMotion, JoinsATranslationAndARotationUnderTheirOwnLimits) {
  const Vector3d start(0.1, -0.2, 0.3), velocity(0.4, 0.9, -2.0), way(-0.2, 0.3, 0.6);
  const auto motion = PoseMotion::plan(plane, start, velocity, way, limits);
  const auto translation =
      SynchronisedMotion::plan(Vector2d(0, 0), velocity.head<2>(), way.head<2>(), limits.translation);
  const auto rotation = JerkLimitedProfile::plan({0.0, -2.0, 0.0, 0.0}, 0.6, limits.rotation);
  ASSERT_TRUE(motion.valid());
  EXPECT_DOUBLE_EQ(motion.duration(), std::max(translation.duration(), rotation.duration()));

  for (int k = 0; k < 100; ++k) {
    const double time = k * motion.duration() / 100;
    const PlatformReference m = motion.evaluate(time);
    ASSERT_TRUE(m.valid);
    EXPECT_FALSE(m.finished);
    EXPECT_LT((m.pose.head(2) - start.head<2>() - translation.evaluate(time).position).norm(), 1e-15);
    EXPECT_EQ(m.velocity.head(2), translation.evaluate(time).velocity);
    EXPECT_EQ(m.acceleration.head(2), translation.evaluate(time).acceleration);
    EXPECT_NEAR(m.pose(2), 0.3 + rotation.evaluate(time).position, 1e-13);
    EXPECT_NEAR(m.velocity(2), rotation.evaluate(time).velocity, 1e-12);
    EXPECT_NEAR(m.acceleration(2), rotation.evaluate(time).acceleration, 1e-9);
  }
}

TEST(PoseMotion, RestsAndIsNotValidOnBadInput) {
  const Vector3d start(1, 2, 3.0), still(0, 0, 0), goal(4, 5, 6), bad(0, not_a_number, 0);
  const Vector2d short_one(1, 2);
  PoseLimits no_rotation = limits;
  no_rotation.rotation.velocity = 0.0;
  for (const PoseMotion& motion :
       {PoseMotion::plan(plane, start, bad, goal, limits), PoseMotion::plan(plane, start, still, bad, limits),
        PoseMotion::plan(plane, start, short_one, goal, limits),
        PoseMotion::plan(plane, start, still, short_one, limits),
        PoseMotion::plan(ConfigurationSpace::Kind::plane, start, still, goal, limits),
        PoseMotion::plan(plane, start, still, goal, no_rotation)}) {
    EXPECT_FALSE(motion.valid());
    EXPECT_EQ(motion.duration(), 0.0);
    EXPECT_FALSE(motion.evaluate(0.1).valid);
    EXPECT_EQ(motion.evaluate(0.1).pose, start);
    EXPECT_EQ(motion.evaluate(0.1).velocity.norm(), 0.0);
  }
  EXPECT_FALSE(PoseMotion{}.evaluate(0.0).valid);
  EXPECT_EQ(PoseMotion{}.goal().size(), 0) << "of no space";
  EXPECT_FALSE(PoseMotion::plan(plane, start, still, goal, limits).evaluate(not_a_number).valid);
}

TEST(PoseMotion, NeedsNoHeap) {
  const ConfigurationSpace space = ConfigurationSpace::Kind::spatial_pose;
  const Configuration start = space.origin();
  const PlatformVector velocity = PlatformVector::Constant(6, 0.4), way = PlatformVector::Constant(6, 0.1);
  const test::AllocationCounter counter;
  const auto motion = PoseMotion::plan(space, start, velocity, way, limits);
  const PlatformReference m = motion.evaluate(0.01);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_TRUE(m.valid);
}

}  // namespace
}  // namespace flinch
