#include "systems/motion/pose_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/support/allocations.h"

namespace flinch {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const PoseLimits limits{{1.0, 20.0, 2000.0}, {4.0, 80.0, 8000.0}};
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

TEST(PoseMotion, JoinsATranslationAndARotationUnderTheirOwnLimits) {
  const Vector3d start(0.1, -0.2, 0.3), velocity(0.4, 0.9, -2.0), goal(-0.1, 0.1, 0.9);
  const auto motion = PoseMotion::plan(start, velocity, goal, 2, limits);
  const auto translation =
      SynchronisedMotion::plan(start.head<2>(), velocity.head<2>(), goal.head<2>(), limits.translation);
  const auto rotation = JerkLimitedProfile::plan({0.3, -2.0, 0.0, 0.0}, 0.9, limits.rotation);
  ASSERT_TRUE(motion.valid());
  EXPECT_DOUBLE_EQ(motion.duration(), std::max(translation.duration(), rotation.duration()));

  for (int k = 0; k < 100; ++k) {
    const double time = k * motion.duration() / 100;
    const PlatformReference m = motion.evaluate(time);
    ASSERT_TRUE(m.valid);
    EXPECT_FALSE(m.finished);
    EXPECT_EQ(m.pose.head(2), translation.evaluate(time).position);
    EXPECT_EQ(m.velocity.head(2), translation.evaluate(time).velocity);
    EXPECT_EQ(m.acceleration.head(2), translation.evaluate(time).acceleration);
    EXPECT_NEAR(m.pose(2), rotation.evaluate(time).position, 1e-13);
    EXPECT_NEAR(m.velocity(2), rotation.evaluate(time).velocity, 1e-12);
    EXPECT_NEAR(m.acceleration(2), rotation.evaluate(time).acceleration, 1e-9);
  }
}

TEST(PoseMotion, FinishesAtRestAtTheGoal) {
  const Vector3d goal(0.2, 0.1, -0.4);
  const auto motion = PoseMotion::plan(Vector3d(0, 0, 0), Vector3d(-1, 1, 3), goal, 2, limits);
  const PlatformReference end = motion.evaluate(motion.duration());
  EXPECT_TRUE(end.valid);
  EXPECT_TRUE(end.finished);
  EXPECT_EQ(end.pose, goal);
  EXPECT_EQ(end.velocity, Vector3d(0, 0, 0));
  EXPECT_EQ(end.acceleration, Vector3d(0, 0, 0));
}

TEST(PoseMotion, ServesARobotThatCannotRotate) {
  const auto motion = PoseMotion::plan(Vector3d(0, 0, 0), Vector3d(0, 0, 0), Vector3d(1, 2, 2), 3, limits);
  ASSERT_TRUE(motion.valid());
  EXPECT_NEAR((motion.evaluate(motion.duration() / 2).pose - Vector3d(0.5, 1, 1)).norm(), 0.0, 1e-12);
}

TEST(PoseMotion, RestsAndIsNotValidOnBadInput) {
  const Vector3d start(1, 2, 3), still(0, 0, 0), goal(4, 5, 6), bad(0, not_a_number, 0);
  const Vector2d short_one(1, 2);
  PoseLimits no_rotation = limits;
  no_rotation.rotation.velocity = 0.0;
  for (const PoseMotion& motion :
       {PoseMotion::plan(start, bad, goal, 2, limits), PoseMotion::plan(start, still, bad, 2, limits),
        PoseMotion::plan(start, short_one, goal, 2, limits),
        PoseMotion::plan(start, still, short_one, 2, limits), PoseMotion::plan(start, still, goal, 0, limits),
        PoseMotion::plan(start, still, goal, 4, limits),
        PoseMotion::plan(start, still, goal, 2, no_rotation)}) {
    EXPECT_FALSE(motion.valid());
    EXPECT_EQ(motion.duration(), 0.0);
    EXPECT_FALSE(motion.evaluate(0.1).valid);
    EXPECT_EQ(motion.evaluate(0.1).pose, start);
    EXPECT_EQ(motion.evaluate(0.1).velocity, still);
  }
  EXPECT_FALSE(PoseMotion{}.evaluate(0.0).valid);
  EXPECT_FALSE(PoseMotion::plan(start, still, goal, 2, limits).evaluate(not_a_number).valid);
}

TEST(PoseMotion, NeedsNoHeap) {
  const PlatformVector start = Vector3d(0, 0, 0), velocity = Vector3d(-1.1, 0.6, 0.5),
                       goal = Vector3d(0.1, 0, 0);
  const test::AllocationCounter counter;
  const auto motion = PoseMotion::plan(start, velocity, goal, 2, limits);
  const PlatformReference m = motion.evaluate(0.01);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_TRUE(m.valid);
}

}  // namespace
}  // namespace flinch
