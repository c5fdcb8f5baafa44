#include "systems/motion/reaction_task.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "systems/foundation/setup_error.h"
#include "systems/robot/reaction_tasks.h"
#include "tests/support/allocations.h"
#include "tests/systems/motion/reaction_rig.h"

namespace flinch::test {
namespace {

TEST(ReactionTask, ThePlatformMovesAlongTheForceFromHowItMovesNow) {
  Reaction reaction;
  reaction.know(platform, {30, -40, 1}, {0.02, 0.01, 0.05}, {0.3, 0.2, 0.1});
  const TaskList& begins = reaction.begin();
  ASSERT_EQ(begins.count, 1);
  EXPECT_LT(begins.goals[0].reference.error.norm(), 1e-12);
  EXPECT_LT((begins.goals[0].reference.rate - Eigen::Vector2d(0.3, 0.2)).norm(), 1e-12);
  reaction.know(platform, {0, 0, 0});
  EXPECT_LT((reaction.goal().reference.error - 0.1 * Eigen::Vector2d(0.6, -0.8)).norm(), 1e-9);
  EXPECT_TRUE(reaction.finished());
}

/// A reaction whose motion has just ended, and a robot that moves otherwise: a limit or a contact kept it
/// from its goal.
struct KeptFromItsGoal : Reaction {
  explicit KeptFromItsGoal(int touched) {
    know(touched, {30, -40, 1}, pose);
    begin();
    know(-1, {0, 0, 0}, pose, velocity);
    go_on();
    for (Time t{}; t < 1000ms && ticking.get(block.goals).goals[0].reference.rate.norm() > 0.0; t += 1ms)
      go_on();
  }
  /// For a tick, the fastest drive with `rate` [rad/s].
  const TaskList& move(double rate) {
    const Eigen::Vector3d v =
        rate / Posture(*robot, pose, velocity).kinematics.rates.active.lpNorm<Eigen::Infinity>() * velocity;
    pose += 1e-3 * v;
    know(-1, {0, 0, 0}, pose, v);
    return go_on();
  }
  /// What the task shall become.
  PlatformVector wanted() {
    const TaskGoal& goal = ticking.get(block.goals).goals[0];
    return goal.task.sigma + goal.reference.error;
  }

  Eigen::Vector3d pose{0.02, 0.01, 0.05}, velocity{0.6, -0.3, 1.5};
};

TEST(ReactionTask, WhenTheMotionIsOverAndTheDrivesRestThePlaceIsHeldAndTheGoalGivenUp) {
  for (const int touched : {platform, leg2_link1, leg2_link2, leg2_clamping}) {
    KeptFromItsGoal reaction(touched);
    const PlatformVector goal = reaction.wanted();
    for (int tick = 1; tick < 100; ++tick) {
      EXPECT_EQ(reaction.move(0.051).count, 1) << touched;
      EXPECT_LT((reaction.wanted() - goal).norm(), 1e-12) << touched;
      EXPECT_FALSE(reaction.finished()) << touched;
    }
    const TaskList& held = reaction.move(0.049);
    ASSERT_TRUE(reaction.holds_a_place()) << touched;
    EXPECT_TRUE(reaction.finished()) << touched;
    EXPECT_LT(reaction.way_back().norm(), 1e-15) << touched << ": it is not brought back";
    const Eigen::Vector3d place = reaction.pose;
    for (int tick = 0; tick < 100; ++tick) reaction.move(3.0);
    EXPECT_GT((place - reaction.pose).norm(), 0.01) << touched;
    EXPECT_LT((reaction.way_back() - (place - reaction.pose)).norm(), 1e-15) << touched;
    for (const TaskGoal& one : held) {
      EXPECT_EQ(one.reference.rate.norm(), 0.0) << touched;
      EXPECT_EQ(one.reference.acceleration.norm(), 0.0) << touched;
    }
    EXPECT_TRUE(reaction.finished()) << touched;
  }
}

TEST(ReactionTask, ARobotThatKeepsMovingIsHeld150MillisecondsAfterTheMotion) {
  KeptFromItsGoal reaction(platform);
  for (int tick = 1; tick < 150; ++tick) EXPECT_EQ(reaction.move(2.0).count, 1) << tick;
  EXPECT_FALSE(reaction.finished());
  reaction.move(2.0);
  ASSERT_TRUE(reaction.holds_a_place());
  EXPECT_TRUE(reaction.finished());
  EXPECT_LT(reaction.way_back().norm(), 1e-15);
}

TEST(ReactionTask, APlaceIsHeldAsStronglyAsIsAsked) {
  Reaction reaction({}, {.position = TaskGains::uniform(1, 1, 2, 3, 4, 5),
                         .orientation = TaskGains::uniform(1, 6, 7, 8, 9, 10)});
  reaction.know(platform, {30, -40, 1});
  reaction.begin();
  reaction.know(platform, {0, 0, 0});
  reaction.goal();
  ASSERT_TRUE(reaction.holds_a_place());
  const TaskList& list = reaction.ticking.get(reaction.block.goals);
  EXPECT_EQ(list.goals[0].gains.force, Eigen::Vector2d(4, 4));
  EXPECT_EQ(list.goals[1].gains.force[0], 9.0);
}

TEST(ReactionTask, AlongTheForceOnlyThePlatformHasOneRow) {
  ReactionTaskSettings settings;
  settings.along_force_only = true;
  Reaction reaction(settings);
  reaction.know(platform, {30, -40, 1});
  ASSERT_EQ(reaction.begin().goals[0].task.rows(), 1);
  EXPECT_NEAR(reaction.goal().reference.error[0], 0.1, 1e-9);
}

TEST(ReactionTask, AFirstLinkTurnsAsItIsPushed) {
  for (const double sign : {-1.0, 1.0}) {
    Reaction reaction;
    reaction.know(leg2_link1, {0, 0, 0});
    const PlatformVector wrench =
        reaction.posture->kinematics.J_qa_x.transpose() * Eigen::Vector3d(0, sign * 10, 0);
    reaction.know(leg2_link1, Eigen::Vector3d(wrench));
    reaction.begin();
    const TaskGoal goal = reaction.goal();
    EXPECT_EQ(goal.task.J, reaction.posture->kinematics.J_qa_x.row(1));
    EXPECT_NEAR(goal.reference.error[0], sign * 0.25, 1e-9);
  }
}

// Along the link acts friction, which turns round when the link gives way.
TEST(ReactionTask, ThePointOfASecondLinkMovesAlongTheForceAcrossIt) {
  Reaction reaction;
  reaction.know(leg2_link2, {5, 20, 0});
  const auto on_axis = [&](double fraction) {
    return CartesianVector(
        reaction.robot->point_on_body(reaction.posture->kinematics, BodyId::link2(1),
                                      reaction.robot->axis_point(BodyId::link2(1), fraction)));
  };
  const Eigen::Vector2d along = Eigen::Vector2d(on_axis(1.0) - on_axis(0.0)).normalized();
  const Eigen::Vector2d across(-along.y(), along.x());
  reaction.place.valid = true;
  reaction.place.body = BodyId::link2(1).index();
  reaction.place.fraction = 0.3;
  reaction.place.force_in_base = Eigen::Vector2d(25.0 * across + 5.0 * along);
  reaction.know(leg2_link2, {5, 20, 0});
  reaction.begin();
  const TaskGoal goal = reaction.goal();
  EXPECT_LT((goal.task.sigma - PlatformVector(on_axis(0.3))).norm(), 1e-12);
  EXPECT_LT((goal.reference.error - 0.1 * across).norm(), 1e-9);
}

TEST(ReactionTask, ASecondLinkThatNobodyHasLocatedMovesAcrossItsAxis) {
  Reaction reaction;
  reaction.know(leg2_link2, {5, 20, 0});
  reaction.begin();
  const TaskGoal goal = reaction.goal();
  const LegPoints& leg = reaction.posture->kinematics.legs[1];
  const PlatformVector axis = leg.coupling_joint - leg.passive_joint;
  EXPECT_NEAR(goal.reference.error.dot(axis), 0.0, 1e-9);
  EXPECT_GT(goal.reference.error.dot(Eigen::Vector2d(5, 20)), 0.0);
}

TEST(ReactionTask, WhatStaysAfterTheMotionIsGivenWayToAnew) {
  Reaction reaction;
  reaction.know(platform, {30, -40, 1});
  reaction.begin();
  reaction.know(platform, {0, 0, 0});
  reaction.go_on(1000ms);
  ASSERT_TRUE(reaction.finished());
  reaction.ticking.set(reaction.reaction,
                       ReactionState{ReactionMode::hold, ReactionMode::react, reaction.ticking.now()});
  reaction.know(platform, {0, 25, 0});
  reaction.go_on(19ms);
  EXPECT_TRUE(reaction.finished()) << "not at once";
  reaction.go_on(2ms);
  EXPECT_FALSE(reaction.finished());
  reaction.know(platform, {0, 0, 0});
  const TaskGoal goal = reaction.goal();
  EXPECT_TRUE(reaction.finished());
  EXPECT_LT((goal.reference.error - Eigen::Vector2d(0, 0.1)).norm(), 1e-9);
}

TEST(ReactionTask, AMotionThatLeadsIntoWhatIsFeltIsDecidedAnew) {
  for (const bool against : {false, true}) {
    Reaction reaction;
    reaction.know(platform, {30, 0, 0});
    reaction.begin();
    reaction.know(platform, {against ? -30.0 : 30.0, 0, 0});
    reaction.go_on(25ms);
    reaction.know(platform, {0, 0, 0});
    const TaskGoal goal = reaction.goal();
    EXPECT_NEAR(goal.reference.error[0], against ? -0.05 : 0.1, 1e-9);
  }
}

// Accelerating takes some 300 N for the first 24 ms; 8 N may be an error of the model then, but not later.
TEST(ReactionTask, WhatItFeelsByAcceleratingIsNoContact) {
  for (const bool stays : {false, true}) {
    Reaction reaction;
    reaction.know(platform, {30, 0, 0});
    reaction.begin();
    reaction.know(platform, {-8, 0, 0});
    reaction.go_on(stays ? 48ms : 24ms);
    reaction.know(platform, {0, 0, 0});
    const TaskGoal goal = reaction.goal();
    EXPECT_NEAR(goal.reference.error[0], stays ? -0.05 : 0.1, 1e-9);
  }
}

/// A platform that has been pressed from the other side so often, each time against the way that it went.
struct PressedAnew : Reaction {
  explicit PressedAnew(int times) {
    know(platform, {30, 0, 0});
    begin();
    for (int time = 0; time < times; ++time) press();
  }
  void press() {
    side = -side;
    know(platform, {30.0 * side, 0, 0});
    go_on(25ms);
    know(platform, {0, 0, 0});
  }
  double side = 1.0;
};

TEST(ReactionTask, EachTimeItIsDecidedAnewItGoesHalfAsFarAndHalfAsFast) {
  for (const int times : {0, 1, 2}) {
    const double share = std::pow(0.5, times);
    PressedAnew reaction(times);
    double fastest = 0.0;
    for (int tick = 0; tick < 60; ++tick) {
      const TaskList& list = reaction.go_on();
      if (list.count == 1) fastest = std::max(fastest, list.goals[0].reference.rate.norm());
    }
    EXPECT_NEAR(fastest, share * 1.0, 1e-9) << times;
    EXPECT_NEAR(reaction.goal().reference.error[0], share * 0.1 * reaction.side, 1e-9) << times;
  }
}

// Between two things it would be driven from one to the other.
TEST(ReactionTask, WhoIsPressedAThirdTimeInARowIsBrakedUntilItRestsFree) {
  PressedAnew reaction(3);
  EXPECT_EQ(reaction.go_on().count, 0);
  reaction.press();
  EXPECT_EQ(reaction.go_on().count, 0) << "from whatever side";
  reaction.go_on(150ms);
  ASSERT_TRUE(reaction.holds_a_place());
  reaction.go_on(110ms);
  reaction.press();
  EXPECT_NEAR(reaction.goal().reference.error[0], 0.1 * reaction.side, 1e-9) << "as at first";
}

TEST(ReactionTask, NothingIsDecidedAnewInOtherModes) {
  Reaction reaction;
  reaction.know(platform, {30, 0, 0});
  reaction.begin();
  reaction.ticking.set(reaction.reaction,
                       ReactionState{ReactionMode::nominal, ReactionMode::hold, reaction.ticking.now()});
  reaction.know(platform, {-30, 0, 0});
  const TaskGoal& goal = reaction.go_on(1000ms).goals[0];
  EXPECT_NEAR(goal.reference.error[0], 0.1, 1e-9);
}

TEST(ReactionTask, TakesItsShareOfWhatAllDrivesTogetherCanDoAsSoonAsTheyCan) {
  for (const int touched : {platform, leg2_link1, leg2_link2, leg2_clamping}) {
    ReactionTaskSettings settings;
    settings.drive_share = 0.7;
    settings.translation.velocity = settings.joint.velocity = settings.largest_platform_speed = 50.0;
    Reaction reaction(settings);
    reaction.know(touched, {30, -40, 1});
    reaction.begin();
    reaction.know(touched, {0, 0, 0});
    const TaskGoal last = reaction.go_on(1ms).goals[0];
    double largest = 0.0, largest_change = 0.0;
    PlatformVector way, before = last.reference.acceleration;
    for (int tick = 0; tick < 200; ++tick) {
      const TaskGoal& goal = reaction.go_on().goals[0];
      if (reaction.holds_a_place()) break;
      const PlatformVector& a = goal.reference.acceleration;
      if (a.norm() > largest) way = a.normalized();
      largest = std::max(largest, a.norm());
      largest_change = std::max(largest_change, (a - before).norm());
      before = a;
    }
    // By torques at their limits, each with the sign that accelerates the task along its way.
    const Kinematics& at = reaction.posture->kinematics;
    const PlatformMatrix M_inverse = reaction.posture->dynamics.M_x.inverse();
    double together = 0.0;
    for (int drive = 0; drive < 3; ++drive) {
      const PlatformVector dv = M_inverse * (100.0 * at.J_qa_x.row(drive).transpose());
      together += std::abs(way.dot(last.task.J * dv));
    }
    EXPECT_NEAR(largest, 0.7 * together, 0.02 * together) << touched;
    EXPECT_NEAR(largest_change, 0.2 * together, 0.02 * together) << touched << ": 20 Nm in a tick, of 100";
  }
}

TEST(ReactionTask, MotionsOfJointsLeaveThePlatformBelowItsLargestSpeed) {
  Reaction reaction;
  reaction.know(leg2_clamping, {20, 5, 0});
  reaction.begin();
  reaction.know(leg2_clamping, {0, 0, 0});
  double fastest = 0.0;
  for (int tick = 0; tick < 500; ++tick) {
    const TaskList& list = reaction.go_on();
    if (reaction.holds_a_place()) break;
    const TaskGoal& goal = list.goals[0];
    const JointVector drives = seen_by_drives(goal.task, reaction.posture->kinematics)
                                   .J.completeOrthogonalDecomposition()
                                   .solve(goal.reference.rate);
    const PlatformVector v = reaction.posture->kinematics.J_x_qa * drives;
    fastest = std::max(fastest, v.head(2).norm());
  }
  EXPECT_LE(fastest, 2.0);
  EXPECT_GT(fastest, 0.3);
}

TEST(ReactionTask, WhatIsNotKnownIsAnsweredByBraking) {
  for (const auto& spoil : {+[](Reaction& r) {
                              r.know(-1, {30, 0, 0});
                            },
                            +[](Reaction& r) {
                              r.know(10, {30, 0, 0});
                            },
                            +[](Reaction& r) {
                              r.know(platform, {0.1, 0.1, 2.0});
                            },
                            +[](Reaction& r) {
                              r.know(platform, {30, 0, 0});
                              ContactClassification unsure;
                              unsure.valid = true;
                              unsure.most_likely = platform;
                              r.ticking.set(r.classification, unsure);
                            }}) {
    Reaction reaction;
    spoil(reaction);
    const TaskList& list = reaction.begin();
    EXPECT_TRUE(list.valid);
    EXPECT_EQ(list.count, 0);
    EXPECT_EQ(reaction.ticking.get(reaction.block.kind), ReactionKind::brake);
    EXPECT_FALSE(reaction.finished());
    reaction.go_on(20ms);
    EXPECT_EQ(reaction.ticking.get(reaction.block.kind), ReactionKind::brake);
    EXPECT_TRUE(reaction.finished());
    reaction.go_on(200ms);
    EXPECT_EQ(reaction.ticking.get(reaction.block.goals).count, 0) << "it yields to what presses";
    reaction.know(-1, {0, 0, 0});
    reaction.go_on(99ms);
    EXPECT_FALSE(reaction.holds_a_place());
    reaction.go_on(2ms);
    EXPECT_TRUE(reaction.holds_a_place());
    EXPECT_TRUE(reaction.finished());
  }
}

TEST(ReactionTask, WhatBecomesKnownSoonAfterTheDetectionIsStillAnswered) {
  for (const int late : {0, 1}) {
    Reaction reaction;
    reaction.know(platform, {2.0, 0.0, 0.0});
    reaction.begin();
    reaction.go_on(late ? 20ms : 15ms);
    reaction.know(platform, {30, -40, 1});
    reaction.go_on(1ms);
    EXPECT_EQ(reaction.ticking.get(reaction.block.kind), late ? ReactionKind::brake : ReactionKind::platform);
    if (late) continue;
    reaction.know(platform, {50, 10, 0});
    reaction.go_on(50ms);
    reaction.know(platform, {0, 0, 0});
    const TaskGoal goal = reaction.goal();
    EXPECT_LT((goal.reference.error - 0.1 * Eigen::Vector2d(0.6, -0.8)).norm(), 1e-9) << "it stays so";
  }
}

TEST(ReactionTask, AFirstLinkThatHardlyAnythingLoadsIsBraked) {
  Reaction reaction;
  reaction.know(leg2_link1, {0, 0, 0});
  EXPECT_EQ(reaction.begin().count, 0);
}

TEST(ReactionTask, ClassPlaceAndDirectionStayAsTheyWereAtTheDetection) {
  Reaction reaction;
  reaction.know(platform, {30, -40, 1});
  reaction.begin();
  reaction.know(leg2_link1, {50, 10, 0});
  reaction.go_on(50ms);
  reaction.know(leg2_link1, {0, 0, 0});
  const TaskGoal goal = reaction.goal();
  EXPECT_LT((goal.reference.error - 0.1 * Eigen::Vector2d(0.6, -0.8)).norm(), 1e-9);
}

TEST(ReactionTask, RefusesSettingsThatMakeNoSense) {
  DiagramBuilder builder("test", 1ms);
  ReactionTaskSettings settings;
  settings.largest_opening = 0.1;
  EXPECT_THROW(builder.add<ReactionTask>("a", planar_rig(), settings), SetupError);
  settings = {};
  settings.translation.jerk = 0.0;
  EXPECT_THROW(builder.add<ReactionTask>("b", planar_rig(), settings), SetupError);
  settings = {};
  settings.drive_share = 1.5;
  EXPECT_THROW(builder.add<ReactionTask>("c", planar_rig(), settings), SetupError);
  settings = {};
  settings.max_torque = 0.0;
  EXPECT_THROW(builder.add<ReactionTask>("d", planar_rig(), settings), SetupError);
  settings = {};
  settings.max_torque_rate = -1.0;
  EXPECT_THROW(builder.add<ReactionTask>("e", planar_rig(), settings), SetupError);
  settings = {};
  settings.rest_speed = 0.0;
  EXPECT_THROW(builder.add<ReactionTask>("f", planar_rig(), settings), SetupError);
  settings = {};
  settings.longest_braking = -1ms;
  EXPECT_THROW(builder.add<ReactionTask>("g", planar_rig(), settings), SetupError);
}

TEST(ReactionTask, DoesNotAllocate) {
  for (const int touched : {platform, leg2_link1, leg2_link2, leg2_clamping}) {
    Reaction reaction;
    reaction.know(touched, {30, -40, 1});
    reaction.ticking.set(reaction.reaction, ReactionState());
    reaction.ticking.tick();
    reaction.ticking.set(reaction.reaction,
                         ReactionState{ReactionMode::react, ReactionMode::nominal, reaction.ticking.now()});
    const AllocationCounter counter;
    for (int tick = 0; tick < 200; ++tick) reaction.ticking.tick();
    EXPECT_EQ(counter.count(), 0);
  }
}

}  // namespace
}  // namespace flinch::test
