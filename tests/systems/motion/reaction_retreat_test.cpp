#include <gtest/gtest.h>

#include <algorithm>

#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "tests/support/allocations.h"
#include "tests/systems/motion/reaction_rig.h"

namespace flinch::test {
namespace {

const Eigen::Vector3d v(0.5, -0.3, 0.8);
const Eigen::Vector3d against(-20, 12, -0.5);  // its power is negative

/// A robot that has moved evenly for 0.4 s.
struct Travelling : Reaction {
  explicit Travelling(const Eigen::Vector3d& velocity, const ReactionTaskSettings& settings = {})
      : Reaction(settings) {
    ticking.set(reaction, ReactionState{ReactionMode::nominal, ReactionMode::stopped, Time::zero()});
    for (Time t{}; t < 400ms; t += 1ms) {
      at = Eigen::Vector3d(0.02, 0.01, 0.05) + to_seconds(t - 400ms) * velocity;
      know(-1, {0, 0, 0}, at, velocity);
      ticking.tick();
    }
  }
  ReactionKind kind() const { return ticking.get(block.kind); }

  Eigen::Vector3d at;
};

struct RanIntoSomething : Travelling {
  RanIntoSomething() : Travelling(v) {
    know(-1, against, at, v);
    begin();
  }
};

TEST(Retreat, WhatTheRobotRanIntoIsLeftTheWayItCameWhateverWasTouched) {
  Travelling robot(v);
  robot.know(-1, against, robot.at, v);
  const TaskList& begins = robot.begin();
  ASSERT_EQ(robot.kind(), ReactionKind::retreat);
  ASSERT_EQ(begins.count, 2);
  EXPECT_LT(begins.goals[0].reference.error.norm(), 1e-12) << "from where it is";
  EXPECT_LT((begins.goals[0].reference.rate - v.head<2>()).norm(), 1e-12) << "and how it moves";
  EXPECT_LT(std::abs(begins.goals[1].reference.rate[0] - v[2]), 1e-12);

  robot.know(-1, {0, 0, 0}, robot.at, v);
  const TaskList& ends = robot.go_on();
  for (Time t{}; t < 1000ms && ends.goals[0].reference.rate.norm() > 0.0; t += 1ms) robot.go_on();
  ASSERT_EQ(robot.kind(), ReactionKind::retreat);
  EXPECT_FALSE(robot.finished()) << "it did not follow";
  Eigen::Vector3d way;
  way << ends.goals[0].reference.error, ends.goals[1].reference.error;
  const double time = -way[0] / v[0];
  EXPECT_LT((way + time * v).norm(), 1e-9) << "to where it was";
  // To a pose at a spacing of 10 ms that is 0.1 m away for the coupling joint that moves most.
  double reach = 0.0;
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const CartesianVector& joint = robot.posture->kinematics.legs[leg].coupling_joint;
    reach = std::max(reach, (joint - robot.at.head<2>()).norm());
  }
  const double most = v.head<2>().norm() + reach * std::abs(v[2]);
  EXPECT_GT(time * most, 0.1 - 1e-9);
  EXPECT_LT(time * most, 0.1 + 0.010 * most);
}

TEST(Retreat, AnArrivedRetreatHoldsItsPlace) {
  RanIntoSomething robot;
  robot.know(-1, {0, 0, 0}, robot.at, {0, 0, 0});
  robot.go_on(1000ms);
  EXPECT_TRUE(robot.finished());
  EXPECT_LT(robot.way_back().norm(), 1e-12);
}

TEST(Retreat, WhoIsPushedOnHisWayOrHardlyMovesIsBraked) {
  Travelling pushed(v);
  pushed.know(-1, -against, pushed.at, v);
  EXPECT_EQ(pushed.begin().count, 0);
  EXPECT_EQ(pushed.kind(), ReactionKind::brake);

  Travelling standing({0.01, 0, 0});
  standing.know(-1, against, standing.at, {0.01, 0, 0});
  EXPECT_EQ(standing.begin().count, 0);
  EXPECT_EQ(standing.kind(), ReactionKind::brake);
}

TEST(Retreat, WhatIsHardlyFeltLeadsNobodyBack) {
  for (const double share : {0.05, 0.5}) {
    Travelling robot(v);
    robot.know(-1, share * 0.3 * against, robot.at, v);  // about 0.3 and 3.4 N along the way
    robot.begin();
    EXPECT_EQ(robot.kind(), share > 0.4 ? ReactionKind::retreat : ReactionKind::brake) << share;
  }
}

TEST(Retreat, WhoIsPushedAgainstHisWayIsBrakedAtOnce) {
  RanIntoSomething robot;
  robot.go_on(5ms);
  EXPECT_EQ(robot.kind(), ReactionKind::retreat);
  robot.know(-1, -against, robot.at, v);
  robot.go_on();
  EXPECT_EQ(robot.kind(), ReactionKind::brake);
}

// A robot that is lighter than its model feels that it is pushed the way it is accelerated, one that is
// heavier the other way.
TEST(Retreat, WhatItsOwnAccelerationMakesTheRobotFeelStopsNobodyAPushStopsHim) {
  for (const double error : {-0.04, 0.04, -0.2}) {
    RanIntoSomething robot;
    double most = 0.0;
    for (Time t{}; t < 20ms; t += 1ms) {
      const TaskList& list = robot.go_on();
      if (list.count != 2) break;
      Eigen::Vector3d acceleration;
      acceleration << list.goals[0].reference.acceleration, list.goals[1].reference.acceleration;
      const Eigen::Vector3d felt = error * (robot.posture->dynamics.M_x * acceleration);
      most = std::max(most, felt.norm());
      robot.know(-1, felt, robot.at, v);
    }
    EXPECT_GT(most, 1.0) << "N: the test means something";
    EXPECT_EQ(robot.kind(), error > -0.1 ? ReactionKind::retreat : ReactionKind::brake) << error;
  }
}

// What it may feel of its own acceleration hides a weaker push for as long as the acceleration lasts.
TEST(Retreat, WhoIsPushedFromBehindByEightNewtonIsBrakedWithin50Milliseconds) {
  for (const double newton : {8.0, 11.0}) {
    RanIntoSomething robot;
    robot.go_on(5ms);
    robot.know(-1, -newton / against.head<2>().norm() * Eigen::Vector3d(against[0], against[1], 0.0),
               robot.at, v);
    Time braked{};
    while (braked < 1000ms && robot.kind() == ReactionKind::retreat) {
      robot.go_on();
      braked += 1ms;
    }
    std::printf("pushed from behind by %2.0f N: braked after %lld ms\n", newton,
                static_cast<long long>(braked / 1ms));
    EXPECT_LE(braked, 50ms) << newton;
  }
}

TEST(Retreat, WhoDoesNotKnowWhatHeFeelsIsBraked) {
  RanIntoSomething robot;
  robot.go_on(5ms);
  ASSERT_EQ(robot.kind(), ReactionKind::retreat);
  robot.ticking.set(robot.estimate, WrenchEstimate{});
  robot.go_on();
  EXPECT_EQ(robot.kind(), ReactionKind::brake);
}

// What is felt then pushes it to where it was touched first.
TEST(Retreat, WhoWentBackOrGaveWayAndIsPushedFromBehindDoesNotReturnToWhatItLeft) {
  const Eigen::Vector3d behind = 0.12 / v.norm() * v;
  for (const Eigen::Vector3d& left : {Eigen::Vector3d(-behind), Eigen::Vector3d(0.06, 0.1, 0.0)}) {
    for (const Time after : {15ms, 100ms, 600ms}) {
      RanIntoSomething robot;
      const Eigen::Vector3d now = robot.at + left;
      robot.know(-1, {0, 0, 0}, now, {0, 0, 0});
      robot.go_on(after);
      robot.know(-1, -30.0 * left / left.norm(), now, {0, 0, 0});
      for (Time t{}; t < 200ms; t += 1ms) {
        const TaskList& list = robot.go_on();
        const bool leads_back = list.count == 2 && list.goals[0].reference.rate.dot(left.head<2>()) < -1e-9;
        EXPECT_FALSE(leads_back && robot.kind() == ReactionKind::retreat)
            << after.count() << ", " << t.count();
      }
      EXPECT_EQ(robot.kind(), ReactionKind::brake) << after.count();
    }
  }
}

TEST(Retreat, WhoShallNotIsBraked) {
  ReactionTaskSettings settings;
  settings.retreat = false;
  Travelling robot(v, settings);
  robot.know(-1, against, robot.at, v);
  robot.begin();
  EXPECT_EQ(robot.kind(), ReactionKind::brake);
}

TEST(Retreat, AClassThatBecomesKnownWithinTheTimeIsFollowedInItsPlaceLaterOnesAreNot) {
  for (const Time later : {0ms, 20ms, 21ms}) {
    RanIntoSomething robot;
    if (later > 1ms) robot.go_on(later - 1ms);
    robot.know(platform, against, robot.at, v);
    robot.go_on();
    EXPECT_EQ(robot.kind(), later <= 20ms ? ReactionKind::platform : ReactionKind::retreat) << later.count();
  }
}

TEST(Retreat, IsToldFromTheDetectionOn) {
  Travelling robot(v);
  robot.know(-1, against, robot.at, v);
  EXPECT_FALSE(robot.ticking.get(robot.block.followed_task).valid) << "nothing was detected yet";
  robot.begin();
  EXPECT_EQ(robot.ticking.get(robot.block.followed_task), (FollowedTask{true, ReactionKind::retreat, -1}));
}

TEST(Retreat, OneThatLeadsIntoSomethingIsDecidedAnew) {
  RanIntoSomething robot;
  robot.go_on(25ms);
  EXPECT_EQ(robot.kind(), ReactionKind::retreat);
  robot.know(-1, -against, robot.at, {0, 0, 0});
  robot.go_on(19ms);
  EXPECT_EQ(robot.kind(), ReactionKind::retreat);
  robot.go_on(3ms);
  EXPECT_EQ(robot.kind(), ReactionKind::brake) << "it yields";
}

TEST(Retreat, WhatWasPressedAgainstByMistakeIsLeftTheWayItCame) {
  Travelling robot(v);
  robot.know(platform, -against, robot.at, v);  // taken for a push from behind
  robot.begin();
  EXPECT_EQ(robot.kind(), ReactionKind::platform);
  robot.know(-1, against, robot.at, v);
  robot.go_on(30ms);
  EXPECT_EQ(robot.kind(), ReactionKind::retreat);
}

/// Any robot, on its way around its home pose.
class RetreatOf : public testing::TestWithParam<std::shared_ptr<const ParallelRobot>> {};

TEST_P(RetreatOf, AnyRobotLeadsBackToAPoseWhereItWasWithoutAllocating) {
  const ParallelRobot& robot = *GetParam();
  const ConfigurationSpace& space = robot.space();
  DiagramBuilder builder("test", 1ms);
  auto& block = builder.add<ReactionTask>("reaction", GetParam(), ReactionTaskSettings{});
  const auto reaction = builder.export_input("reaction", block.reaction);
  const auto kinematics = builder.export_input("kinematics", block.kinematics);
  const auto dynamics = builder.export_input("dynamics", block.dynamics);
  const auto estimate = builder.export_input("estimate", block.estimate);
  builder.connect(builder.optional_input<ContactClassification>("class"), block.classification);
  builder.connect(builder.optional_input<ContactLocation>("place"), block.location);
  Ticking ticking(builder);

  PlatformVector velocity = PlatformVector::LinSpaced(robot.dof(), 0.3, -0.25);
  Configuration pose = robot.home_pose();
  std::vector<Configuration> path;
  ticking.set(reaction, ReactionState{ReactionMode::nominal, ReactionMode::stopped, Time::zero()});
  for (int k = 0; k < 150; ++k) {
    const Posture posture(robot, pose, velocity);
    ticking.set(kinematics, posture.kinematics);
    ticking.set(dynamics, posture.dynamics);
    path.push_back(pose);
    ticking.tick();
    if (k < 149) pose = space.plus(pose, 1e-3 * velocity);
  }
  WrenchEstimate felt;
  felt.valid = true;
  felt.wrench_in_base = -20.0 * velocity;
  ticking.set(estimate, felt);
  ticking.set(reaction, ReactionState{ReactionMode::react, ReactionMode::nominal, ticking.now()});
  {
    const AllocationCounter counter;
    ticking.tick();
    EXPECT_EQ(counter.count(), 0);
  }
  ASSERT_EQ(ticking.get(block.kind), ReactionKind::retreat);
  felt.wrench_in_base.setZero();
  ticking.set(estimate, felt);
  const TaskList& list = ticking.get(block.goals);
  for (int k = 0; k < 1000 && list.goals[0].reference.rate.norm() > 0.0; ++k) ticking.tick();
  PlatformVector way(robot.dof());
  way.head(space.translations()) = list.goals[0].reference.error;
  if (space.rotations() > 0) way.tail(space.rotations()) = list.goals[1].reference.error;
  EXPECT_GT(way.norm(), 0.02);
  double nearest = 1e9;
  for (const Configuration& was : path)
    nearest = std::min(nearest, space.difference(space.plus(pose, way), was).norm());
  EXPECT_LT(nearest, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Robots, RetreatOf,
                         testing::Values(planar_rig(), std::make_shared<FiveBar>(five_bar_robot()),
                                         std::make_shared<Hexapod>(hexapod_robot())),
                         [](const auto& robot) {
                           return "with_" + std::to_string(robot.param->dof()) + "_drives";
                         });

}  // namespace
}  // namespace flinch::test
