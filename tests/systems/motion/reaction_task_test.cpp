#include "systems/motion/reaction_task.h"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "systems/robot/reaction_tasks.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_bench.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

struct Reaction {
  explicit Reaction(const ReactionTaskSettings& settings = {})
      : block(builder.add<ReactionTask>("reaction", robot, settings)) {}

  /// What the robot knows at the next tick. `touched`: a number in `classes`; -1: nobody knows.
  void know(int touched, const Eigen::Vector3d& wrench, const Eigen::Vector3d& pose = {0.02, 0.01, 0.05},
            const Eigen::Vector3d& velocity = {0, 0, 0}) {
    posture.emplace(*robot, pose, velocity);
    ticking.set(kinematics, posture->kinematics);
    ticking.set(dynamics, posture->dynamics);
    WrenchEstimate felt;
    felt.valid = true;
    felt.wrench_in_base = wrench;
    felt.drive_torque = posture->kinematics.J_x_qa.transpose() * wrench;
    ticking.set(estimate, felt);
    ContactClassification told;
    told.valid = told.accepted = touched >= 0;
    told.most_likely = touched;
    ticking.set(classification, told);
    ticking.set(location, place);
  }
  const TaskList& begin() {
    ticking.set(reaction, ReactionState{ReactionMode::react, ReactionMode::nominal, ticking.now()});
    ticking.tick();
    return ticking.get(block.goals);
  }
  const TaskList& go_on(Time for_time = 1ms) {
    for (Time t{}; t < for_time; t += 1ms) ticking.tick();
    return ticking.get(block.goals);
  }
  bool finished() const { return ticking.get(block.reference).finished; }

  std::shared_ptr<const PlanarRrr> robot = test::planar_bench();
  ContactClasses classes{7, 3};
  ContactLocation place;
  std::optional<test::Posture> posture;
  DiagramBuilder builder{"test", 1ms};
  ReactionTask& block;
  InputPort<ReactionState> reaction = builder.export_input("reaction", block.reaction);
  InputPort<Kinematics> kinematics = builder.export_input("kinematics", block.kinematics);
  InputPort<Dynamics> dynamics = builder.export_input("dynamics", block.dynamics);
  InputPort<WrenchEstimate> estimate = builder.export_input("estimate", block.estimate);
  InputPort<ContactClassification> classification =
      builder.export_input("classification", block.classification);
  InputPort<ContactLocation> location = builder.export_input("location", block.location);
  test::Ticking ticking{builder};
};

/// A motion by which the elbow of the second leg bends, its first link half as fast times `advance` towards
/// what is between the links; and forces of that.
struct ClosingLeg {
  ClosingLeg(const PlanarRrr& robot, const Eigen::Vector3d& pose, double advance = 1.0) {
    const test::Posture still(robot, pose, Eigen::Vector3d::Zero());
    const Kinematics& at = still.kinematics;
    const double s = std::copysign(1.0, at.joints.passive[1]);
    const PlatformMatrix J = stacked(drive_task(at, 1), passive_joint_task(at, 1)).J;
    twist = J.completeOrthogonalDecomposition().solve(Eigen::Vector2d(0.5 * s * advance, s));
    force_on_link1 = at.J_qa_x.transpose() * Eigen::Vector3d(0, -10.0 * s, 0);
    const LegPoints& leg = at.legs[1];
    force_on_link2.head(2) = 20.0 * (leg.passive_joint - leg.base_joint).normalized();
  }
  Eigen::Vector3d twist;
  Eigen::Vector3d force_on_link1;                            ///< as seen at the platform
  Eigen::Vector3d force_on_link2 = Eigen::Vector3d::Zero();  ///< likewise
};

constexpr int platform = 0;
constexpr int leg2_link1 = 3;
constexpr int leg2_link2 = 4;
constexpr int leg2_clamping = 8;
const Eigen::Vector3d pushing_apart(-20, -5, 0);  // the links of the second leg

TEST(ReactionTask, ThePlatformMovesAlongTheForceFromHowItMovesNow) {
  Reaction reaction;
  reaction.know(platform, {30, -40, 1}, {0.02, 0.01, 0.05}, {0.3, 0.2, 0.1});
  const TaskList& begins = reaction.begin();
  ASSERT_EQ(begins.count, 1);
  EXPECT_LT(begins.goals[0].reference.error.norm(), 1e-12);
  EXPECT_LT((begins.goals[0].reference.rate - Eigen::Vector2d(0.3, 0.2)).norm(), 1e-12);
  reaction.know(platform, {0, 0, 0});
  const TaskList& arrives = reaction.go_on(1000ms);
  EXPECT_LT((arrives.goals[0].reference.error - 0.1 * Eigen::Vector2d(0.6, -0.8)).norm(), 1e-9);
  EXPECT_TRUE(reaction.finished());
}

TEST(ReactionTask, AlongTheForceOnlyThePlatformHasOneRow) {
  ReactionTaskSettings settings;
  settings.along_force_only = true;
  Reaction reaction(settings);
  reaction.know(platform, {30, -40, 1});
  ASSERT_EQ(reaction.begin().goals[0].task.rows(), 1);
  EXPECT_NEAR(reaction.go_on(1000ms).goals[0].reference.error[0], 0.1, 1e-9);
}

TEST(ReactionTask, AFirstLinkTurnsAsItIsPushed) {
  for (const double sign : {-1.0, 1.0}) {
    Reaction reaction;
    reaction.know(leg2_link1, {0, 0, 0});
    const PlatformVector wrench =
        reaction.posture->kinematics.J_qa_x.transpose() * Eigen::Vector3d(0, sign * 10, 0);
    reaction.know(leg2_link1, Eigen::Vector3d(wrench));
    reaction.begin();
    const TaskGoal& goal = reaction.go_on(1000ms).goals[0];
    EXPECT_EQ(goal.task.J, reaction.posture->kinematics.J_qa_x.row(1));
    EXPECT_NEAR(goal.reference.error[0], sign * 0.25, 1e-9);
  }
}

TEST(ReactionTask, ThePointOfASecondLinkMovesAlongTheForceOnIt) {
  Reaction reaction;
  reaction.place.valid = true;
  reaction.place.body = BodyId::link2(1).index();
  reaction.place.fraction = 0.3;
  reaction.place.force_in_base = Eigen::Vector2d(0, 25);
  reaction.know(leg2_link2, {5, 20, 0});
  reaction.begin();
  const TaskGoal& goal = reaction.go_on(1000ms).goals[0];
  const CartesianVector point = reaction.robot->point_on_body(
      reaction.posture->kinematics, BodyId::link2(1), reaction.robot->axis_point(BodyId::link2(1), 0.3));
  EXPECT_LT((goal.task.sigma - PlatformVector(point)).norm(), 1e-12);
  EXPECT_LT((goal.reference.error - Eigen::Vector2d(0, 0.1)).norm(), 1e-9);
}

TEST(ReactionTask, ASecondLinkThatNobodyHasLocatedMovesAcrossItsAxis) {
  Reaction reaction;
  reaction.know(leg2_link2, {5, 20, 0});
  reaction.begin();
  const TaskGoal& goal = reaction.go_on(1000ms).goals[0];
  const LegPoints& leg = reaction.posture->kinematics.legs[1];
  const PlatformVector axis = leg.coupling_joint - leg.passive_joint;
  EXPECT_NEAR(goal.reference.error.dot(axis), 0.0, 1e-9);
  EXPECT_GT(goal.reference.error.dot(Eigen::Vector2d(5, 20)), 0.0);
}

// The gap between the links is the elbow's angle against a stretched leg: |q_p| falls.
TEST(ReactionTask, AClampingLegOpensAndItsFirstLinkRetreats) {
  Reaction reaction;
  reaction.know(leg2_clamping, {20, 5, 0});
  reaction.begin();
  reaction.know(leg2_clamping, {0, 0, 0});
  const TaskGoal& goal = reaction.go_on(1000ms).goals[0];
  ASSERT_EQ(goal.task.rows(), 2);
  const double s = std::copysign(1.0, reaction.posture->kinematics.joints.passive[1]);
  EXPECT_NEAR(goal.reference.error[0], -s * 0.2094, 1e-9);
  EXPECT_NEAR(goal.reference.error[1], -2.0 * s * 0.2094, 1e-9);
}

// There was room for what it clamps before the robot came: a first link that hardly moved hardly retreats.
TEST(ReactionTask, ALegThatClosesOpensTheWayItCame) {
  const Eigen::Vector3d pose(0.02, 0.01, 0.05);
  for (const int touched : {leg2_clamping, leg2_link1, leg2_link2}) {
    for (const double retreat : {-0.5, 0.0, 0.25, 1.0, 3.0}) {
      Reaction reaction;
      const ClosingLeg leg(*reaction.robot, pose, retreat);
      reaction.know(touched, touched == leg2_link2 ? leg.force_on_link2 : leg.force_on_link1, pose,
                    leg.twist);
      reaction.begin();
      reaction.know(touched, {0, 0, 0}, pose);
      const Eigen::Vector2d goal = reaction.go_on(1000ms).goals[0].reference.error;
      EXPECT_EQ(reaction.ticking.get(reaction.block.kind), ReactionKind::opening) << touched;
      const double s = std::copysign(1.0, reaction.posture->kinematics.joints.passive[1]);
      EXPECT_NEAR(goal[0], -s * 0.2094 * std::clamp(retreat, 0.0, 1.0), 1e-9) << touched;
      EXPECT_NEAR(goal[1], -2.0 * s * 0.2094, 1e-9) << touched;
    }
  }
}

TEST(ReactionTask, ALinkThatIsTouchedFromOutsideOfAClosingLegDoesNotOpenIt) {
  const Eigen::Vector3d pose(0.02, 0.01, 0.05);
  for (const int touched : {leg2_link1, leg2_link2}) {
    Reaction reaction;
    const ClosingLeg leg(*reaction.robot, pose);
    reaction.know(touched, touched == leg2_link2 ? -leg.force_on_link2 : -leg.force_on_link1, pose,
                  leg.twist);
    reaction.begin();
    EXPECT_EQ(reaction.ticking.get(reaction.block.kind),
              touched == leg2_link1 ? ReactionKind::first_link : ReactionKind::second_link);
  }
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
  const TaskGoal& goal = reaction.go_on(1000ms).goals[0];
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
    const TaskGoal& goal = reaction.go_on(1000ms).goals[0];
    EXPECT_NEAR(goal.reference.error[0], against ? -0.1 : 0.1, 1e-9);
  }
}

TEST(ReactionTask, NothingIsDecidedAnewInOtherModes) {
  Reaction reaction;
  reaction.know(platform, {30, 0, 0});
  reaction.begin();
  reaction.ticking.set(reaction.reaction,
                       ReactionState{ReactionMode::nominal, ReactionMode::hold, reaction.ticking.now()});
  reaction.know(platform, {-30, 0, 0});
  reaction.go_on(1000ms);
  EXPECT_TRUE(reaction.finished());
}

TEST(ReactionTask, AClampingLegOpensFurtherUntilNothingIsFeltForAWhile) {
  Reaction reaction;
  reaction.know(leg2_clamping, pushing_apart);
  reaction.begin();
  reaction.go_on(400ms);
  EXPECT_FALSE(reaction.finished());
  reaction.know(leg2_clamping, {1, 1, 0.1});
  reaction.go_on(99ms);
  EXPECT_FALSE(reaction.finished());
  const double opened = std::abs(reaction.go_on(1000ms).goals[0].reference.error[0]);
  EXPECT_TRUE(reaction.finished());
  EXPECT_GT(opened, 0.2094 + 0.1047 - 1e-9);
  EXPECT_NEAR(std::abs(reaction.go_on(1000ms).goals[0].reference.error[0]), opened, 1e-12);
}

// What an opening meets when it has long let go of what it clamped is not clamped by it.
TEST(ReactionTask, AReleasedLegDoesNotOpenFurtherForWhatIsFeltLater) {
  Reaction reaction;
  reaction.know(leg2_clamping, {20, 5, 0});
  reaction.begin();
  reaction.know(leg2_clamping, {0, 0, 0});
  const double opened = std::abs(reaction.go_on(1000ms).goals[0].reference.error[0]);
  EXPECT_NEAR(opened, 0.2094, 1e-9);
  for (const double sign : {1.0, -1.0}) {
    reaction.know(leg2_clamping, {20 * sign, 5 * sign, 0});
    reaction.go_on(1000ms);
    EXPECT_EQ(reaction.ticking.get(reaction.block.kind), ReactionKind::brake) << "it yields";
  }
}

// Of two forces on the leg, one helps it to open and one stands in its way.
TEST(ReactionTask, AnOpeningGoesOnOnlyWhereWhatIsFeltDoesNotOpposeIt) {
  int furthered = 0, yielded = 0;
  for (const double sign : {1.0, -1.0}) {
    Reaction reaction;
    reaction.know(leg2_clamping, {20 * sign, 5 * sign, 0});
    const TaskList& begins = reaction.begin();
    ASSERT_EQ(begins.count, 1);
    const Kinematics& at = reaction.posture->kinematics;
    const double s = std::copysign(1.0, at.joints.passive[1]);
    const PlatformMatrix J = stacked(drive_task(at, 1), passive_joint_task(at, 1)).J;
    const Eigen::Vector3d opening = J.completeOrthogonalDecomposition().solve(Eigen::Vector2d(-s, -2.0 * s));
    const bool helps = opening.dot(Eigen::Vector3d(20 * sign, 5 * sign, 0)) > 0.0;
    reaction.go_on(400ms);
    const bool opens = reaction.ticking.get(reaction.block.kind) == ReactionKind::opening;
    EXPECT_EQ(opens, helps);
    furthered += opens ? 1 : 0;
    yielded += opens ? 0 : 1;
  }
  EXPECT_EQ(furthered, 1);
  EXPECT_EQ(yielded, 1);
}

TEST(ReactionTask, TakesItsShareOfWhatAllDrivesTogetherCanDo) {
  for (const int touched : {platform, leg2_link1, leg2_link2, leg2_clamping}) {
    ReactionTaskSettings settings;
    settings.drive_share = 0.7;
    settings.translation.velocity = settings.joint.velocity = settings.largest_platform_speed = 50.0;
    Reaction reaction(settings);
    reaction.know(touched, {30, -40, 1});
    reaction.begin();
    reaction.know(touched, {0, 0, 0});
    const TaskGoal last = reaction.go_on(1ms).goals[0];
    double largest = 0.0;
    PlatformVector way;
    for (int tick = 0; tick < 200; ++tick) {
      const TaskGoal& goal = reaction.go_on().goals[0];
      const PlatformVector& a = goal.reference.acceleration;
      if (a.norm() > largest) way = a.normalized();
      largest = std::max(largest, a.norm());
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
  }
}

TEST(ReactionTask, AnOpeningEndsAtTheLargestThoughItIsNotReleasedAndThenYields) {
  Reaction reaction;
  reaction.know(leg2_clamping, pushing_apart);
  reaction.begin();
  double largest = 0.0;
  for (int tick = 0; tick < 10000; ++tick) {
    const TaskList& list = reaction.go_on();
    if (list.count > 0) largest = std::max(largest, std::abs(list.goals[0].reference.error[0]));
  }
  EXPECT_NEAR(largest, 0.6981, 1e-9);
  EXPECT_EQ(reaction.ticking.get(reaction.block.kind), ReactionKind::brake);
  EXPECT_TRUE(reaction.finished());
}

TEST(ReactionTask, MotionsOfJointsLeaveThePlatformBelowItsLargestSpeed) {
  Reaction reaction;
  reaction.know(leg2_clamping, {20, 5, 0});
  reaction.begin();
  reaction.know(leg2_clamping, {0, 0, 0});
  double fastest = 0.0;
  for (int tick = 0; tick < 500; ++tick) {
    const TaskGoal& goal = reaction.go_on().goals[0];
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
    const TaskGoal& goal = reaction.go_on(1000ms).goals[0];
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
  const TaskGoal& goal = reaction.go_on(1000ms).goals[0];
  EXPECT_LT((goal.reference.error - 0.1 * Eigen::Vector2d(0.6, -0.8)).norm(), 1e-9);
}

TEST(ReactionTask, RefusesSettingsThatMakeNoSense) {
  DiagramBuilder builder("test", 1ms);
  ReactionTaskSettings settings;
  settings.largest_opening = 0.1;
  EXPECT_THROW(builder.add<ReactionTask>("a", test::planar_bench(), settings), SetupError);
  settings = {};
  settings.translation.jerk = 0.0;
  EXPECT_THROW(builder.add<ReactionTask>("b", test::planar_bench(), settings), SetupError);
  settings = {};
  settings.drive_share = 1.5;
  EXPECT_THROW(builder.add<ReactionTask>("c", test::planar_bench(), settings), SetupError);
}

TEST(ReactionTask, DoesNotAllocate) {
  for (const int touched : {platform, leg2_link1, leg2_link2, leg2_clamping}) {
    Reaction reaction;
    reaction.know(touched, {30, -40, 1});
    reaction.ticking.set(reaction.reaction, ReactionState());
    reaction.ticking.tick();
    reaction.ticking.set(reaction.reaction,
                         ReactionState{ReactionMode::react, ReactionMode::nominal, reaction.ticking.now()});
    const test::AllocationCounter counter;
    for (int tick = 0; tick < 200; ++tick) reaction.ticking.tick();
    EXPECT_EQ(counter.count(), 0);
  }
}

}  // namespace
}  // namespace flinch
