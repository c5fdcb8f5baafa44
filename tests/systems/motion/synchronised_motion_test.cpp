#include "systems/motion/synchronised_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/allocations.h"

namespace flinch {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

TEST(SynchronisedMotionExample, MovesAllCoordinatesInProportion) {
  const auto motion =
      SynchronisedMotion::plan(Vector2d(1, 1), Vector2d(0, 0), Vector2d(4, 5), {2.0, 4.0, 16.0});
  // Ramps of 0.5 s + 0.25 s over 0.75 m each, 3.5 m at 2 m/s between them.
  EXPECT_NEAR(motion.duration(), 0.75 + 1.75 + 0.75, 1e-13);
  const VectorMotion m = motion.evaluate(0.75);
  EXPECT_TRUE(m.valid);
  EXPECT_LE((m.position - Vector2d(1.45, 1.6)).norm(), 1e-13);
  EXPECT_LE((m.velocity - Vector2d(1.2, 1.6)).norm(), 1e-13);
}

/// The profile across the line has 1/sqrt(2) of the jerk; it returns at the initial speed divided by the
/// golden ratio (see the scalar example). After that the motion is on the line.
TEST(SynchronisedMotionExample, BrakesAcrossTheLineAndComesBackToIt) {
  const double jerk = 30.0, v = 0.5, w = v / std::numbers::phi;
  const auto motion =
      SynchronisedMotion::plan(Vector2d(0, 0), Vector2d(0, v), Vector2d(3, 0), {1.0, 100.0, jerk});
  const double share = jerk / std::numbers::sqrt2;
  const double turn = 2 * std::sqrt((v + w) / share), back = turn + 2 * std::sqrt(w / share);
  EXPECT_NEAR(motion.evaluate(turn).velocity(1), -w, 1e-12);
  EXPECT_GT(motion.evaluate(0.9 * back).position(1), 1e-6);
  for (const double time : {back, 1.1 * back, 2 * back, motion.duration()}) {
    EXPECT_NEAR(motion.evaluate(time).position(1), 0.0, 1e-12);
    EXPECT_NEAR(motion.evaluate(time).velocity(1), 0.0, 1e-12);
  }
  EXPECT_NEAR(motion.evaluate(motion.duration() / 2).velocity(0), 1.0, 1e-12);
}

TEST(SynchronisedMotionExample, BrakesAlongTheVelocityAndReturnsIfItIsAtTheGoal) {
  const Vector3d here(1, 2, 3), velocity(0.3, 0.0, -0.4);
  const auto motion = SynchronisedMotion::plan(here, velocity, here, {1.0, 20.0, 2000.0});
  ASSERT_TRUE(motion.valid());
  for (const double part : {0.1, 0.4, 0.8}) {
    const Vector3d moved = motion.evaluate(part * motion.duration()).position - here;
    EXPECT_NEAR(moved.normalized().dot(velocity.normalized()), 1.0, 1e-9);
  }
}

TEST(SynchronisedMotionExample, TakesNoTimeForNoDistance) {
  const auto motion =
      SynchronisedMotion::plan(Vector2d(1, 2), Vector2d(0, 0), Vector2d(1, 2), {1.0, 1.0, 1.0});
  EXPECT_TRUE(motion.valid());
  EXPECT_EQ(motion.duration(), 0.0);
  EXPECT_EQ(motion.evaluate(0.0).position, Vector2d(1, 2));
}

TEST(SynchronisedMotionExample, MakesTinyMotions) {
  const auto motion =
      SynchronisedMotion::plan(Vector2d(0, 0), Vector2d(0, 0), Vector2d(6e-13, -8e-13), {1.0, 20.0, 2000.0});
  EXPECT_TRUE(motion.valid());
  EXPECT_NEAR(motion.duration(), 4 * std::cbrt(1e-12 / 4000), 1e-12);
  EXPECT_LE((motion.evaluate(motion.duration() / 2).position - Vector2d(3e-13, -4e-13)).norm(), 1e-24);
}

void expect_resting(const SynchronisedMotion& motion, const PlatformVector& position) {
  EXPECT_FALSE(motion.valid());
  EXPECT_EQ(motion.duration(), 0.0);
  const VectorMotion m = motion.evaluate(0.5);
  EXPECT_FALSE(m.valid);
  EXPECT_EQ(m.position, position);
  EXPECT_EQ(m.velocity, PlatformVector::Zero(position.size()));
  EXPECT_EQ(m.acceleration, PlatformVector::Zero(position.size()));
}

TEST(SynchronisedMotionExample, RestsAndIsNotValidOnBadInput) {
  const MotionLimits limits{1.0, 2.0, 8.0};
  const Vector2d start(1, 2), still(0, 0), goal(3, 4), bad(0, not_a_number);
  expect_resting(SynchronisedMotion::plan(start, bad, goal, limits), start);
  expect_resting(SynchronisedMotion::plan(start, still, bad, limits), start);
  expect_resting(SynchronisedMotion::plan(start, still, Vector3d(1, 2, 3), limits), start);
  expect_resting(SynchronisedMotion::plan(start, Vector3d(0, 0, 0), goal, limits), start);
  expect_resting(SynchronisedMotion::plan(start, still, goal, {1.0, 0.0, 8.0}), start);
  expect_resting(SynchronisedMotion::plan(start, Vector2d(0, 1), goal, {1.0, 2.0, not_a_number}), start);
  expect_resting(SynchronisedMotion{}, PlatformVector());
  EXPECT_FALSE(SynchronisedMotion::plan(bad, still, goal, limits).valid());
  EXPECT_FALSE(SynchronisedMotion::plan(start, still, goal, limits).evaluate(not_a_number).valid);
}

TEST(SynchronisedMotionExample, NeedsNoHeap) {
  const PlatformVector start = Vector2d(0, 0), velocity = Vector2d(-1.1, 0.6), goal = Vector2d(0.1, 0);
  const test::AllocationCounter counter;
  const auto motion = SynchronisedMotion::plan(start, velocity, goal, {1.0, 20.0, 2000.0});
  const VectorMotion m = motion.evaluate(0.01);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_TRUE(m.valid);
}

}  // namespace
}  // namespace flinch
