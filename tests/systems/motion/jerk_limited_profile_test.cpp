#include "systems/motion/jerk_limited_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>
#include <vector>

#include "tests/support/allocations.h"

namespace flinch {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

static_assert(std::is_trivially_copyable_v<JerkLimitedProfile>);

void expect_motion(const ScalarMotion& motion, double position, double velocity, double acceleration) {
  EXPECT_NEAR(motion.position, position, 1e-13);
  EXPECT_NEAR(motion.velocity, velocity, 1e-13);
  EXPECT_NEAR(motion.acceleration, acceleration, 1e-13);
}

TEST(JerkLimitedProfileExample, HasSevenPhasesFromRestToRest) {
  const auto profile = JerkLimitedProfile::plan({}, 1.75, {1.0, 2.0, 8.0});
  EXPECT_TRUE(profile.valid());
  EXPECT_EQ(profile.phases().size(), 7u);
  EXPECT_DOUBLE_EQ(profile.duration(), 2.5);
  expect_motion(profile.evaluate(0.25), 1.0 / 48, 0.25, 2.0);
  expect_motion(profile.evaluate(0.50), 1.0 / 48 + 0.125, 0.75, 2.0);
  expect_motion(profile.evaluate(0.75), 0.375, 1.0, 0.0);
  expect_motion(profile.evaluate(1.25), 0.875, 1.0, 0.0);
  expect_motion(profile.evaluate(2.00), 1.75 - 1.0 / 48 - 0.125, 0.75, -2.0);
  EXPECT_EQ(profile.evaluate(0.1).jerk, 8.0);
  EXPECT_EQ(profile.evaluate(0.3).jerk, 0.0);
  EXPECT_EQ(profile.evaluate(0.6).jerk, -8.0);
}

TEST(JerkLimitedProfileExample, BrakesAtOnceIfThatEndsAtTheGoal) {
  const auto profile = JerkLimitedProfile::plan({0.0, 1.0, 0.0, 0.0}, 0.5, {2.0, 10.0, 4.0});
  EXPECT_EQ(profile.phases().size(), 2u);
  EXPECT_DOUBLE_EQ(profile.duration(), 1.0);
  expect_motion(profile.evaluate(0.5), 0.5 - 1.0 / 12, 0.5, -2.0);
}

/// Without acceleration limit the way back is made at the initial speed divided by the golden ratio:
/// (v - w) sqrt(v + w) = w^(3/2).
TEST(JerkLimitedProfileExample, OvershootsAndComesBackToWhereItStarts) {
  const double jerk = 3.0, v = 1.0, w = v / std::numbers::phi;
  const auto profile = JerkLimitedProfile::plan({0.7, v, 0.0, 0.0}, 0.7, {2.0, 10.0, jerk});
  const double turn = 2 * std::sqrt((v + w) / jerk);
  EXPECT_NEAR(profile.duration(), turn + 2 * std::sqrt(w / jerk), 1e-13);
  EXPECT_NEAR(profile.evaluate(turn).velocity, -w, 1e-13);
  EXPECT_NEAR(profile.evaluate(turn).acceleration, 0.0, 1e-13);
}

TEST(JerkLimitedProfileExample, TurnsRoundIfItMovesTheWrongWay) {
  const auto profile = JerkLimitedProfile::plan({0.0, -1.0, 0.0, 0.0}, 0.5, {2.0, 10.0, 4.0});
  EXPECT_NEAR(profile.duration(), std::sqrt(2.0) + 1.0, 1e-13);
  expect_motion(profile.evaluate(std::sqrt(2.0)), 0.0, 1.0, 0.0);
}

TEST(JerkLimitedProfileExample, SlowsDownToTheVelocityLimitFirst) {
  const auto profile = JerkLimitedProfile::plan({0.0, 2.0, 0.0, 0.0}, 10.0, {1.0, 1.0, 1.0});
  EXPECT_DOUBLE_EQ(profile.duration(), 10.0);
  expect_motion(profile.evaluate(1.0), 2.0 - 1.0 / 6, 1.5, -1.0);
  expect_motion(profile.evaluate(2.0), 3.0, 1.0, 0.0);
  expect_motion(profile.evaluate(8.0), 9.0, 1.0, 0.0);
}

TEST(JerkLimitedProfileExample, TakesAwayTooMuchAccelerationFirst) {
  const auto profile = JerkLimitedProfile::plan({0.0, 0.0, 2.0, 0.0}, 1000.0, {100.0, 1.0, 1.0});
  expect_motion(profile.evaluate(1.0), 1.0 - 1.0 / 6, 1.5, 1.0);
  expect_motion(profile.evaluate(3.0), 1.0 - 1.0 / 6 + 3.0 + 2.0, 3.5, 1.0);
}

TEST(JerkLimitedProfileExample, TakesNoTimeForNoDistance) {
  const auto profile = JerkLimitedProfile::plan({0.3, 0.0, 0.0, 0.0}, 0.3, {1.0, 1.0, 1.0});
  EXPECT_TRUE(profile.valid());
  EXPECT_EQ(profile.duration(), 0.0);
  EXPECT_TRUE(profile.phases().empty());
  for (const double time : {-1.0, 0.0, 1.0}) expect_motion(profile.evaluate(time), 0.3, 0.0, 0.0);
}

TEST(JerkLimitedProfileExample, MakesTinyMotionsAsPreciselyAsLargeOnes) {
  for (const double distance : {1e-12, -1e-12, 1e-20}) {
    const auto profile = JerkLimitedProfile::plan({}, distance, {1.0, 20.0, 2000.0});
    EXPECT_TRUE(profile.valid());
    const double duration = 4 * std::cbrt(std::abs(distance) / 4000.0);
    EXPECT_NEAR(profile.duration(), duration, 1e-12 * duration);
    EXPECT_NEAR(profile.evaluate(duration / 2).position, distance / 2, 1e-12 * std::abs(distance));
  }
}

TEST(JerkLimitedProfileExample, RestsAtTheGoalAfterItsEndAndAtTheStartBeforeIt) {
  const auto profile = JerkLimitedProfile::plan({1.0, 0.5, 0.25, 7.0}, -2.0, {1.0, 2.0, 8.0});
  expect_motion(profile.evaluate(-1.0), 1.0, 0.5, 0.25);
  for (const double time : {profile.duration(), profile.duration() + 1.0, infinite}) {
    const ScalarMotion end = profile.evaluate(time);
    EXPECT_EQ(end.position, -2.0);
    EXPECT_EQ(end.velocity, 0.0);
    EXPECT_EQ(end.acceleration, 0.0);
    EXPECT_EQ(end.jerk, 0.0);
  }
  EXPECT_TRUE(std::isnan(profile.evaluate(not_a_number).position));
}

void expect_resting(const JerkLimitedProfile& profile, double position) {
  EXPECT_FALSE(profile.valid());
  EXPECT_EQ(profile.duration(), 0.0);
  for (const double time : {-1.0, 0.0, 1.0}) {
    EXPECT_EQ(profile.evaluate(time).position, position);
    EXPECT_EQ(profile.evaluate(time).velocity, 0.0);
  }
}

TEST(JerkLimitedProfileExample, RestsAndIsNotValidOnBadInput) {
  const MotionLimits limits{1.0, 2.0, 8.0};
  for (const double bad : {not_a_number, infinite, -infinite}) {
    EXPECT_FALSE(JerkLimitedProfile::plan({bad, 0.0, 0.0, 0.0}, 1.0, limits).valid());
    expect_resting(JerkLimitedProfile::plan({0.3, bad, 0.0, 0.0}, 1.0, limits), 0.3);
    expect_resting(JerkLimitedProfile::plan({0.3, 0.0, bad, 0.0}, 1.0, limits), 0.3);
    expect_resting(JerkLimitedProfile::plan({0.3, 0.0, 0.0, 0.0}, bad, limits), 0.3);
  }
  for (const double bad : {0.0, -1.0, not_a_number, infinite}) {
    expect_resting(JerkLimitedProfile::plan({0.3, 0.1, 0.0, 0.0}, 1.0, {bad, 2.0, 8.0}), 0.3);
    expect_resting(JerkLimitedProfile::plan({0.3, 0.1, 0.0, 0.0}, 1.0, {1.0, bad, 8.0}), 0.3);
    expect_resting(JerkLimitedProfile::plan({0.3, 0.1, 0.0, 0.0}, 1.0, {1.0, 2.0, bad}), 0.3);
  }
  expect_resting(JerkLimitedProfile::plan({0.3, 1e300, 0.0, 0.0}, 1.0, limits), 0.3);
  expect_resting(JerkLimitedProfile::plan({0.3, 0.0, 1e300, 0.0}, 1.0, limits), 0.3);
  expect_resting(JerkLimitedProfile{}, 0.0);
}

TEST(JerkLimitedProfileExample, NeedsNoHeap) {
  const test::AllocationCounter counter;
  const auto profile = JerkLimitedProfile::plan({0.0, 1.3, -5.0, 0.0}, -0.1, {1.0, 20.0, 2000.0});
  const double position = profile.evaluate(profile.duration() / 2).position;
  EXPECT_EQ(counter.count(), 0);
  EXPECT_TRUE(std::isfinite(position));
}

}  // namespace
}  // namespace flinch
