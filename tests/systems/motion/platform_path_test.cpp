#include "systems/motion/platform_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "systems/foundation/setup_error.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"

namespace flinch {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const PoseLimits limits{.translation = {1.0, 20.0, 2000.0}, .rotation = {4.0, 80.0, 8000.0}};

PlatformVector pose(double x, double y, double phi) { return Eigen::Vector3d(x, y, phi); }

/// Velocity and acceleration are the derivatives of the pose, at every millisecond but those with a corner of
/// jerk.
void expect_consistent(const PlatformPath& path) {
  constexpr double h = 1e-5;
  for (double t = 2 * h; t < path.duration(); t += 1e-3) {
    const PlatformReference before = path.evaluate(t - h), now = path.evaluate(t),
                            after = path.evaluate(t + h);
    ASSERT_TRUE(now.valid);
    ASSERT_LT(((after.pose - before.pose) / (2 * h) - now.velocity).norm(), 1e-5) << t;
    ASSERT_LT(((after.velocity - before.velocity) / (2 * h) - now.acceleration).norm(), 0.1) << t;
  }
}

TEST(PlatformPath, RestsAtEveryPoseInTurn) {
  const auto robot = test::planar_rig();
  const std::vector<Configuration> poses{pose(0, 0, 0), pose(0.1, 0, 0.1), pose(0.1, 0.05, -0.2)};
  const PlatformPath path = PlatformPath::through(*robot, poses, limits);
  EXPECT_EQ(path.start(), poses[0]);
  EXPECT_EQ(path.evaluate(-1.0).pose, poses[0]);
  EXPECT_LT((path.evaluate(path.duration()).pose - poses[2]).norm(), 1e-15);
  EXPECT_TRUE(path.evaluate(path.duration()).finished);
  EXPECT_FALSE(path.evaluate(path.duration() - 1e-3).finished);
  double nearest = 1.0, speed_there = 1.0;
  for (double t = 0.0; t < path.duration(); t += 1e-4) {
    const PlatformReference now = path.evaluate(t);
    if ((now.pose - poses[1]).norm() < nearest) {
      nearest = (now.pose - poses[1]).norm();
      speed_there = now.velocity.norm();
    }
    EXPECT_FALSE(now.finished) << t;
  }
  EXPECT_LT(nearest, 1e-8);
  EXPECT_LT(speed_there, 1e-4);
  expect_consistent(path);
}

TEST(PlatformPath, PausesOnTheWay) {
  const auto robot = test::planar_rig();
  const std::vector<Configuration> poses{pose(0, 0, 0), pose(0.1, 0, 0.1), pose(0.1, 0.05, -0.2)};
  const PlatformPath without = PlatformPath::through(*robot, poses, limits);
  const PlatformPath path = PlatformPath::through(*robot, poses, limits, 0.3);
  EXPECT_NEAR(path.duration(), without.duration() + 0.3, 1e-12);
  const double there = PlatformPath::through(*robot, {poses[0], poses[1]}, limits).duration();
  for (const double time : {there, there + 0.15, there + 0.299}) {
    EXPECT_LT((path.evaluate(time).pose - poses[1]).norm(), 1e-12);
    EXPECT_LT(path.evaluate(time).velocity.norm(), 1e-12);
    EXPECT_FALSE(path.evaluate(time).finished);
  }
  EXPECT_GT(path.evaluate(there + 0.35).velocity.norm(), 0.0);
  EXPECT_THROW(PlatformPath::through(*robot, poses, limits, -0.1), SetupError);
  EXPECT_THROW(PlatformPath::through(*robot, poses, limits, nan), SetupError);
}

TEST(PlatformPath, TurnsTheShorterWayRound) {
  const auto robot = test::planar_rig();
  const double turn = 2.0 * std::acos(-1.0);
  const PlatformPath path = PlatformPath::through(*robot, {pose(0, 0, 0.1), pose(0, 0, turn - 0.1)}, limits);
  EXPECT_NEAR(path.evaluate(path.duration()).pose[2], -0.1, 1e-12);
}

TEST(PlatformPath, StaysAtASinglePose) {
  const PlatformPath path = PlatformPath::through(*test::planar_rig(), {pose(0.05, 0, 0)}, limits);
  EXPECT_EQ(path.duration(), 0.0);
  EXPECT_EQ(path.evaluate(3.0).pose, pose(0.05, 0, 0));
  EXPECT_TRUE(path.evaluate(0.0).finished);
}

TEST(PlatformPath, GoesRoundTheSquareAsOftenAsAsked) {
  const auto robot = test::planar_rig();
  const PlatformPath once = PlatformPath::square(*robot, pose(0, 0, 0), 0.2, limits);
  const PlatformPath twice = PlatformPath::square(*robot, pose(0, 0, 0), 0.2, limits, 2);
  EXPECT_NEAR(twice.duration(), 2.0 * once.duration(), 1e-12);
  EXPECT_EQ(once.start(), pose(-0.1, -0.1, 0.0));
  EXPECT_EQ(once.evaluate(once.duration()).pose, once.start());
  expect_consistent(once);
}

TEST(PlatformPath, IsNotValidAtATimeThatIsNone) {
  const PlatformPath path =
      PlatformPath::through(*test::planar_rig(), {pose(0, 0, 0), pose(0.1, 0, 0)}, limits);
  EXPECT_FALSE(path.evaluate(nan).valid);
}

TEST(PlatformPath, NeverAllocatesOnceItExists) {
  const auto robot = test::planar_rig();
  const PlatformPath path =
      PlatformPath::through(*robot, {pose(0, 0, 0), pose(0.1, 0, 0), pose(0, 0, 0.1)}, limits);
  const PlatformPath square = PlatformPath::square(*robot, pose(0, 0, 0), 0.2, limits);
  const test::AllocationCounter counter;
  for (double t = 0.0; t < 1.0; t += 0.01) EXPECT_TRUE(path.evaluate(t).valid && square.evaluate(t).valid);
  EXPECT_EQ(counter.count(), 0);
}

TEST(PlatformPath, RefusesWhatCannotBeDriven) {
  const auto robot = test::planar_rig();
  EXPECT_THROW(PlatformPath::through(*robot, {}, limits), SetupError);
  EXPECT_THROW(PlatformPath::through(*robot, {pose(nan, 0, 0)}, limits), SetupError);
  EXPECT_THROW(PlatformPath::through(*robot, {pose(0, 0, 0), Eigen::Vector2d(0, 0)}, limits), SetupError);
  EXPECT_THROW(PlatformPath::through(*robot, {pose(0, 0, 0), pose(3, 0, 0)}, limits), SetupError)
      << "out of reach";
  EXPECT_THROW(PlatformPath::through(*robot, {pose(0, 0, 0), pose(0.1, 0, 0)}, {}), SetupError);
  EXPECT_THROW(PlatformPath::square(*robot, pose(0, 0, 0), 0.2, limits, 0), SetupError);
}

TEST(PlatformPath, RefusesAWayThatTakesForEver) {
  const auto robot = test::planar_rig();
  const std::vector<Configuration> poses{pose(0, 0, 0), pose(0.1, 0, 0)};
  for (const double speed : {1e-6, 1e-12, 1e-300}) {
    PoseLimits slow = limits;
    slow.translation.velocity = speed;
    EXPECT_THROW(PlatformPath::through(*robot, poses, slow), SetupError) << speed;
    EXPECT_THROW(PlatformPath::square(*robot, pose(0, 0, 0), 0.2, slow), SetupError) << speed;
  }
  EXPECT_THROW(PlatformPath::through(*robot, {poses[0], poses[1], poses[0]}, limits, 1e9), SetupError);
}

TEST(PlatformPath, ChecksOneOfManyLaps) {
  const auto robot = test::planar_rig();
  const double lap = PlatformPath::square(*robot, pose(0, 0, 0), 0.2, limits).duration();
  const PlatformPath many = PlatformPath::square(*robot, pose(0, 0, 0), 0.2, limits, 2'000'000'000);
  EXPECT_NEAR(many.duration(), 2e9 * lap, 1.0);
}

// ---------------------------------------------------------------- passages

class PassageAtSpeed : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Passage, PassageAtSpeed, testing::Values(0.1, 0.4, 0.7, 1.0, 1.25, 1.5));

TEST_P(PassageAtSpeed, PassesThePoseAtItsTimeWithConstantVelocity) {
  const double v = GetParam();
  const PassageSettings settings{
      .pose = pose(0.02, -0.01, 0.05), .direction = Eigen::Vector2d(3.0, 4.0), .speed = v, .cruise = 0.02};
  const Passage passing = passage(*test::planar_rig(), settings);
  const Eigen::Vector3d velocity(0.6 * v, 0.8 * v, 0.0);
  EXPECT_LT((passing.path.evaluate(passing.time).pose - settings.pose).norm(), 1e-12);
  for (double s = -0.0199; s < 0.02; s += 0.001) {
    const PlatformReference now = passing.path.evaluate(passing.time + s / v);
    EXPECT_LT((now.velocity - PlatformVector(velocity)).norm(), 1e-9) << s;
    EXPECT_LT(now.acceleration.norm(), 1e-9) << s;
    EXPECT_FALSE(now.finished);
  }
  EXPECT_TRUE(passing.path.evaluate(passing.path.duration()).finished) << "and would brake after it";
  expect_consistent(passing.path);
}

TEST_P(PassageAtSpeed, KeepsItsLimits) {
  const Passage passing = passage(
      *test::planar_rig(),
      {.pose = pose(0, 0, 0), .direction = Eigen::Vector2d(1.0, 0.0), .speed = GetParam(), .cruise = 0.02});
  for (double t = 0.0; t < passing.path.duration(); t += 1e-3) {
    const PlatformReference now = passing.path.evaluate(t);
    EXPECT_LE(now.velocity.norm(), GetParam() * (1 + 1e-12));
    EXPECT_LE(now.acceleration.norm(), 20.0 * (1 + 1e-12));
  }
}

TEST(Passage, RefusesWhatCannotBePassed) {
  const auto robot = test::planar_rig();
  const PassageSettings good{.pose = pose(0, 0, 0), .direction = Eigen::Vector2d(1.0, 0.0), .speed = 0.5};
  PassageSettings bad[] = {good, good, good, good, good};
  bad[0].speed = 0.0;
  bad[1].direction = Eigen::Vector2d::Zero();
  bad[2].direction = Eigen::Vector3d::UnitX();
  bad[3].pose = Eigen::Vector2d::Zero();
  bad[4].pose = pose(0.6, 0, 0);
  EXPECT_NO_THROW(passage(*robot, good));
  for (const PassageSettings& settings : bad) EXPECT_THROW(passage(*robot, settings), SetupError);
}

}  // namespace
}  // namespace flinch
