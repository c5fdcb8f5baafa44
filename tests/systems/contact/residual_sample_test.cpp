#include "systems/contact/residual_sample.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/signals/driven_share.h"
#include "tests/support/answer_of_filters.h"
#include "tests/support/told_disturbance_filter.h"

namespace flinch {
namespace {

const DriveLoad at_rest{.acquired = {},
                        .valid = true,
                        .rate = Eigen::Vector3d::Zero(),
                        .torque = Eigen::Vector3d::Zero(),
                        .friction = Eigen::Vector3d::Zero(),
                        .friction_bounds = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()},
                        .inertia = Eigen::Vector3d::Zero(),
                        .turning = Eigen::Vector3d::Zero()};

WrenchEstimate estimate_of(const JointVector& effort) {
  WrenchEstimate estimate;
  estimate.valid = true;
  estimate.drive_torque = effort;
  return estimate;
}

/// Follows the residual of an estimator that answers through filters, a tick a time.
class Follower {
 public:
  explicit Follower(const FilterResponse& answer) { tracking_.answer = answer; }

  const ResidualSample& see(WrenchEstimate estimate, DriveLoad load) {
    now_ += 1ms;
    estimate.acquired = load.acquired = now_;
    ResidualMemory next;
    track_residual(estimate, load, past_, now_, tracking_, memory_, next);
    past_.push(load);
    memory_ = next;
    return memory_.seen;
  }
  void miss(Time time) { now_ += time; }

 private:
  ResidualTracking tracking_;
  LoadHistory past_;
  ResidualMemory memory_;
  Time now_{};
};

const FilterResponse three_poles{.filters = 3, .rate = DisturbanceFilterSettings{}.pole};

TEST(ResidualSample, HasTheLoadBehindTheFiltersOfItsEstimator) {
  Follower follower(three_poles);
  DriveLoad load = at_rest;
  for (int k = -50; k < 60; ++k) {
    if (k >= 0) load.friction[0] = 1.0;
    if (k >= 0) load.torque[0] += 1.0;
    const ResidualSample& seen = follower.see(estimate_of(Eigen::Vector3d::Zero()), load);
    // Discrete filters are half a tick each ahead of those of the formula.
    const double sooner = test::answer_of_three_filters(0.3 * (k + 2));
    const double later = test::answer_of_three_filters(0.3 * k);
    EXPECT_GE(seen.level.friction[0], later) << k;
    EXPECT_LE(seen.level.friction[0], sooner) << k;
    EXPECT_GE(seen.level.slope[0], 1e3 * later) << k;
    EXPECT_LE(seen.level.slope[0], 1e3 * sooner) << k;
    EXPECT_EQ(seen.load.torque, load.torque) << "the load itself has no lag";
  }
}

/// The answers of both filters of three poles to friction that is unknown from some tick on.
TEST(ResidualSample, LosesWhatDryFrictionCanMakeOfItAndNothingElse) {
  Follower follower(three_poles);
  DriveLoad load = at_rest;
  double friction = 0.0, low = 0.0, high = 0.0;  // behind the same filters, one after the other
  std::array<double, 3> of_friction{}, of_low{}, of_high{};
  const auto through = [](std::array<double, 3>& filters, double value) {
    for (double& each : filters) value = each += (1.0 - std::exp(-0.3)) * (value - each);
    return value;
  };
  follower.see(estimate_of(Eigen::Vector3d::Zero()), load);
  for (int k = 0; k < 60; ++k) {
    if (k == 10) load.friction_bounds.low[0] = -0.75, load.friction_bounds.high[0] = 0.5;
    if (k == 30) load.friction_bounds.low[0] = load.friction_bounds.high[0] = 0.0;
    const double applied = k < 10 || k >= 30 ? 0.0 : (k % 2 == 0 ? 0.5 : -0.75);  // whatever lies within
    friction = through(of_friction, applied);
    low = through(of_low, load.friction_bounds.low[0]);
    high = through(of_high, load.friction_bounds.high[0]);
    EXPECT_NEAR(follower.see(estimate_of(Eigen::Vector3d(friction, 0.0, 0.0)), load).level.effort[0], 0.0,
                1e-15)
        << k;
  }
  load.friction_bounds.low[0] = -0.75, load.friction_bounds.high[0] = 0.5;
  for (int k = 0; k < 60; ++k) {
    low = through(of_low, load.friction_bounds.low[0]);
    high = through(of_high, load.friction_bounds.high[0]);
    const double effort = k % 2 == 0 ? 3.0 : -3.0;
    const ResidualSample& seen = follower.see(estimate_of(Eigen::Vector3d(effort, 0.1, 0.0)), load);
    EXPECT_NEAR(seen.level.effort[0], effort - (effort > 0.0 ? high : low), 1e-15) << k;
    EXPECT_EQ(seen.level.effort[1], 0.1) << "another drive";
  }
}

TEST(ResidualSample, BeginsWithFiltersThatHaveSettled) {
  Follower follower(three_poles);
  DriveLoad load = at_rest;
  load.torque[0] = 4.0;
  for (int times = 0; times < 2; ++times) {
    const ResidualSample& seen = follower.see(estimate_of(Eigen::Vector3d::Zero()), load);
    EXPECT_EQ(seen.level.torque[0], load.torque[0]);
    EXPECT_EQ(seen.level.slope[0], 0.0);
    load.torque[0] = -7.0;
    follower.miss(1s);
  }
}

TEST(ResidualSample, OfAnEstimatorWithoutFiltersHasTheLoadOfItsTime) {
  Follower follower({});
  DriveLoad load = at_rest;
  follower.see(estimate_of(Eigen::Vector3d::Zero()), load);
  load.torque[0] = 4.0;
  const ResidualSample& seen = follower.see(estimate_of(Eigen::Vector3d::Zero()), load);
  EXPECT_EQ(seen.level.torque[0], 4.0);
  EXPECT_NEAR(seen.level.slope[0], 4e3, 1e-9);
}

TEST(ResidualSample, HasTheLoadOfAnInstantBetweenTwoTicks) {
  LoadHistory past;
  ResidualMemory memory, next;
  for (int k = 1; k < 20; ++k) {
    DriveLoad load = at_rest;
    load.acquired = k * 1ms;
    load.torque[0] = load.friction[1] = load.rate[2] = load.inertia[0] = k;
    WrenchEstimate estimate = estimate_of(Eigen::Vector3d::Zero());
    estimate.acquired = load.acquired - (k % 2 ? 400us : 150us);  // its clock is its own
    track_residual(estimate, load, past, load.acquired, {}, memory, next);
    past.push(load);
    memory = next;
    if (k < 3) continue;
    const double then = to_seconds(estimate.acquired) * 1e3;
    ASSERT_TRUE(memory.seen.is_new);
    EXPECT_EQ(memory.seen.load.acquired, estimate.acquired);
    EXPECT_NEAR(memory.seen.level.torque[0], then, 1e-12) << k;
    EXPECT_NEAR(memory.seen.level.friction[1], then, 1e-12) << k;
    EXPECT_NEAR(memory.seen.load.rate[2], then, 1e-12) << k;
    EXPECT_NEAR(memory.seen.load.inertia[0], then, 1e-12) << k;
    EXPECT_NEAR(memory.seen.level.slope[0], 1e3, 1e-8) << k;
  }
}

TEST(ResidualSample, HasTheSlopeOfTheTorqueThatTheDrivesHeldAtItsInstant) {
  for (const Time before : {0us, 50us, 500us, 950us}) {
    LoadHistory past;
    ResidualMemory memory, next;
    for (int k = 1; k < 20; ++k) {
      DriveLoad load = at_rest;
      load.acquired = k * 1ms;
      load.torque[0] = k == 10 ? 2.0 : 0.0;
      WrenchEstimate estimate = estimate_of(Eigen::Vector3d::Zero());
      estimate.acquired = load.acquired - before;
      track_residual(estimate, load, past, load.acquired, {}, memory, next);
      past.push(load);
      memory = next;
      const double expected = k == 10 ? 2e3 : k == 11 ? -2e3 : 0.0;
      EXPECT_NEAR(memory.seen.level.slope[0], expected, 1e-9)
          << k << ", " << to_seconds(before) << " s before";
    }
  }
}

// A drive that steps from 1 to 3 Nm at a tick: soon after it anything between has to be expected, later not.
TEST(ResidualSample, DoubtsHowFarTheDrivesHaveGoneSoonAfterATick) {
  for (const Time since_tick : {50us, 300us, 700us, 1000us}) {
    LoadHistory past;
    ResidualMemory memory, next;
    for (int k = 1; k < 20; ++k) {
      DriveLoad load = at_rest;
      load.acquired = k * 1ms;
      load.torque[0] = k < 10 ? 1.0 : 3.0;
      WrenchEstimate estimate = estimate_of(Eigen::Vector3d::Zero());
      estimate.acquired = load.acquired - 1ms + since_tick;
      track_residual(estimate, load, past, load.acquired, {}, memory, next);
      past.push(load);
      memory = next;
      const double from = 1.0 + 2.0 * (2.0 * driven_share(since_tick) - 1.0);  // the slowest
      const double half = k == 10 && since_tick < 1ms ? 0.5 * (3.0 - from) : 0.0;
      EXPECT_NEAR(memory.seen.level.rising[0], half, 1e-12) << k << ", " << to_seconds(since_tick) << " s";
      EXPECT_EQ(memory.seen.level.rising[1], 0.0);
    }
  }
}

// Nobody says when within the gap the torque changed.
TEST(ResidualSample, DoubtsTheSingleStepWhereATickIsLost) {
  LoadHistory past;
  ResidualMemory memory, next;
  for (const int k : {1, 2, 3, 5, 6}) {
    DriveLoad load = at_rest;
    load.acquired = k * 1ms;
    load.torque[0] = k < 5 ? 1.0 : 3.0;
    WrenchEstimate estimate = estimate_of(Eigen::Vector3d::Zero());
    estimate.acquired = load.acquired - (k == 5 ? 1200us : 50us);
    track_residual(estimate, load, past, load.acquired, {}, memory, next);
    past.push(load);
    memory = next;
    EXPECT_EQ(memory.seen.level.rising[0], k == 5 ? 2.0 : 0.0) << k;
  }
}

TEST(ResidualSample, IsSmoothedByALowPass) {
  const ResidualTracking tracking;
  Follower follower({});
  DriveLoad load = at_rest;
  for (int k = 0; k < 100; ++k) follower.see(estimate_of(Eigen::Vector3d::Zero()), load);
  load.torque[1] = 3.0;
  for (int k = 1; k < 40; ++k) {
    const ResidualSample& seen = follower.see(estimate_of(Eigen::Vector3d(2.0, 0.0, 0.0)), load);
    const double share = 1.0 - std::exp(-tracking.smoothing * 1e-3 * k);  // of a first-order filter
    EXPECT_NEAR(seen.smoothed.effort[0], 2.0 * share, 1e-12) << k;
    EXPECT_NEAR(seen.smoothed.torque[1], 3.0 * share, 1e-12) << k;
    EXPECT_NEAR(seen.smoothed.rest[2], 1.0, 1e-12) << k;
  }
}

TEST(ResidualSample, SmoothsAnewBehindAGap) {
  Follower follower({});
  follower.see(estimate_of(Eigen::Vector3d::Zero()), at_rest);
  follower.miss(1s);
  const ResidualSample& seen = follower.see(estimate_of(Eigen::Vector3d(2.0, 0.0, 0.0)), at_rest);
  EXPECT_EQ(seen.smoothed.effort[0], 2.0);
  EXPECT_FALSE(seen.smooth);
}

TEST(ResidualSample, KnowsWhichDrivesStandStill) {
  Follower follower({});
  DriveLoad load = at_rest;
  load.rate = Eigen::Vector3d(0.0, -ResidualTracking{}.resting_rate, 1.0);
  const ResidualSample& seen = follower.see(estimate_of(Eigen::Vector3d::Zero()), load);
  EXPECT_EQ(seen.level.rest[0], 1.0);
  EXPECT_NEAR(seen.level.rest[1], std::exp(-1.0), 1e-12);
  EXPECT_LT(seen.level.rest[2], 1e-100);
}

TEST(ResidualSample, OfADisturbanceFilterLivesOnTheTicks) {
  Follower follower(three_poles);
  DriveLoad load = at_rest;
  for (int k = 0; k < 20; ++k) {
    load.torque[0] = k % 2;
    EXPECT_EQ(follower.see(estimate_of(Eigen::Vector3d::Zero()), load).level.rising, Eigen::Vector3d::Zero());
  }
}

/// The disturbance filter of a robot that stands still, whatever torque is told.
class StandingRobot {
 public:
  WrenchEstimate told(double torque) {
    const test::Posture posture(*robot_, Eigen::Vector3d(0.05, -0.03, 0.1), PlatformVector::Zero(3),
                                filter_.now());
    filter_.tick(posture, Eigen::Vector3d(torque, 0.0, 0.0));
    return filter_.wrench();
  }

 private:
  std::shared_ptr<const PlanarRrr> robot_ = test::planar_rig();
  test::ToldDisturbanceFilter filter_{robot_};
};

// Of a torque that is told but does not act, the whole is an error: what the estimator holds for an effort
// from outside is its opposite.
TEST(ResidualSample, HasAWrongTorqueAsLateAsTheDisturbanceFilterHoldsItForAnEffort) {
  StandingRobot robot;
  Follower follower(three_poles);
  constexpr double wrong = 0.5;  // Nm
  for (int k = -60; k < 60; ++k) {
    DriveLoad load = at_rest;
    load.torque[0] = k < 0 ? 0.0 : wrong;
    const WrenchEstimate estimate = robot.told(load.torque[0]);
    const ResidualSample& seen = follower.see(estimate, load);
    if (k < -20) continue;
    ASSERT_TRUE(estimate.valid) << k;
    // Half a tick between filters and poles: a tenth of the answer's steepest slope.
    EXPECT_NEAR(seen.level.effort[0], -seen.level.torque[0], 0.05 * wrong) << k;
    if (k < 0 || k > 3) continue;
    EXPECT_LT(std::abs(seen.level.effort[0]), 0.2 * wrong) << "still to come, at " << k;
  }
}

}  // namespace
}  // namespace flinch
